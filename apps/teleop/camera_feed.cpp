#include "camera_feed.hpp"

#include <algorithm>
#include <cmath>

namespace repel::teleop {
namespace {

using std::chrono::steady_clock;

percepts::DepthCamera camera_of(const scene::CameraChoice& choice) {
  percepts::DepthCamera camera;
  camera.width = choice.width;
  camera.height = choice.height;
  camera.fx = camera.fy = 0.5 * choice.width / std::tan(0.5 * choice.view);
  camera.cx = 0.5 * (choice.width - 1);
  camera.cy = 0.5 * (choice.height - 1);
  camera.nearest = choice.nearest;
  camera.farthest = choice.farthest;
  return camera;
}

std::size_t images_waiting(const scene::CameraChoice& choice) {
  return static_cast<std::size_t>(std::ceil(choice.latency * choice.rate_hz)) + 2;
}

}  // namespace

CameraFeed::CameraFeed(const scene::CameraChoice& choice, const Sights& sights,
                       const CameraPlace& place)
    : choice_(choice),
      camera_(camera_of(choice_)),
      simulated_(camera_, sights.meshes(),
                 {.noise = choice_.noise, .lost = choice_.lost, .seed = choice_.seed}),
      own_(camera_, sights.known(), choice_.margin),
      maker_(make_part_maker(choice_, camera_, place)),
      image_(camera_.pixels()),
      X_C_(sights.size(), Pose::Identity()),
      ring_(images_waiting(choice_), Scenery{0.0, X_C_}),
      period_(place.period) {
  result_.name = choice_.name.empty() ? "camera" : choice_.name;
}

void CameraFeed::follow(double time, const std::vector<Pose>& X_W, bool is_blind) noexcept {
  now_.store(time, std::memory_order_release);
  // Half a tick early or late, so that images are equally spaced whatever the rates are.
  if (time < next_ - 0.5 * period_) return;
  next_ = std::max(next_ + 1.0 / choice_.rate_hz, time);
  if (is_blind) return;
  ring_.draft().time = time;
  ring_.draft().X_W = X_W;
  (void)ring_.post();
}

void CameraFeed::count_silence(double elapsed) noexcept {
  if (silent_for() > 0.0) silent_ += elapsed;
}

bool CameraFeed::serve(bool early) {
  const Scenery* const oldest = ring_.front();
  if (oldest == nullptr) return false;
  const bool was_new = !has_looked_;
  if (was_new) look(*oldest);
  const double now = now_.load(std::memory_order_acquire);
  if (now < oldest->time + choice_.latency - 0.5 * period_) return was_new && early;
  const auto begin = steady_clock::now();
  const MadeParts made = maker_->make();
  result_.compute.record(looking_ + (steady_clock::now() - begin));
  ++result_.images;
  result_.most_cells = std::max(result_.most_cells, made.cells);
  result_.largest_cube = std::max(result_.largest_cube, made.cube);
  result_.left_out += made.left_out;
  result_.made += made.added;
  seen_at_.store(oldest->time, std::memory_order_release);
  has_looked_ = false;
  ring_.pop();
  return true;
}

void CameraFeed::look(const Scenery& scenery) {
  const Pose X_CW = choice_.X_WC.inverse();
  for (std::size_t i = 0; i < X_C_.size(); ++i) X_C_[i] = composed(X_CW, scenery.X_W[i]);
  simulated_.take(X_C_, image_);
  const auto begin = steady_clock::now();
  (void)own_.remove(X_C_, image_);
  maker_->look(image_, scenery.time);
  looking_ = steady_clock::now() - begin;
  has_looked_ = true;
}

double CameraFeed::silent_for() const noexcept {
  const double age =
      now_.load(std::memory_order_relaxed) - seen_at_.load(std::memory_order_acquire);
  return age > choice_.silent_after ? age : 0.0;
}

ImageResult CameraFeed::result() const {
  ImageResult result = result_;
  result.lost = ring_.dropped();
  result.silent = silent_;
  return result;
}

}  // namespace repel::teleop
