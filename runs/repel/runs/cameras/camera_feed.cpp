// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/cameras/camera_feed.hpp>

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/percepts/depth_image_file.hpp>

namespace repel::runs {
namespace {

using std::chrono::steady_clock;

percepts::DepthCamera camera_of(const scene::CameraChoice& choice) {
  percepts::DepthCamera camera;
  camera.width = choice.width;
  camera.height = choice.height;
  camera.fx = camera.fy = 0.5 * choice.width / std::tan(0.5 * choice.view);
  camera.cx = 0.5 * (choice.width - 1);
  camera.cy = 0.5 * (choice.height - 1);
  if (const auto& recording = choice.recording) {
    camera.fx = recording->fx, camera.fy = recording->fy;
    camera.cx = recording->cx, camera.cy = recording->cy;
  }
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
      own_(camera_, sights.known(), choice_.margin),
      maker_(make_part_maker(choice_, camera_, place)),
      image_(camera_.pixels()),
      X_C_(sights.size(), Pose::Identity()),
      ring_(images_waiting(choice_), Scenery{0.0, 0, X_C_}),
      period_(place.period),
      index_(place.index),
      on_image_(place.listeners.on_image) {
  result_.name = choice_.name.empty() ? "camera" : choice_.name;
  if (!choice_.recording) {
    simulated_.emplace(
        camera_, sights.meshes(),
        percepts::CameraFaults{.noise = choice_.noise, .lost = choice_.lost, .seed = choice_.seed});
    return;
  }
  const std::vector<scene::RecordedImage>& images = choice_.recording->images;
  round_ = images.back().time - images.front().time + 1.0 / choice_.rate_hz;
  for (const scene::RecordedImage& image : images) {
    percepts::check_depth_image(image.file, camera_);
  }
}

void CameraFeed::follow(double time, const std::vector<Pose>& X_W, bool is_blind) noexcept {
  now_.store(time, std::memory_order_release);
  if (choice_.recording) return follow_recording(time, X_W, is_blind);
  // Half a tick early or late, so that images are equally spaced whatever the rates are.
  if (time < next_ - 0.5 * period_) return;
  next_ = std::max(next_ + 1.0 / choice_.rate_hz, time);
  if (!is_blind) post(time, 0, X_W);
}

void CameraFeed::follow_recording(double time, const std::vector<Pose>& X_W,
                                  bool is_blind) noexcept {
  const std::size_t first = next_image_;
  next_image_ = std::max(first, due_until(time + 0.5 * period_));
  if (next_image_ == first) return;
  // Of several that have become due since the last tick, the last.
  skipped_ += static_cast<std::int64_t>(next_image_ - first) - 1;
  const std::size_t last = next_image_ - 1;
  const std::vector<scene::RecordedImage>& images = choice_.recording->images;
  const double begin = round_ * static_cast<double>(last / images.size());
  const std::size_t image = last % images.size();
  if (!is_blind) post(begin + images[image].time - images.front().time, image, X_W);
}

std::size_t CameraFeed::due_until(double time) const noexcept {
  const std::vector<scene::RecordedImage>& images = choice_.recording->images;
  // However many there are, and however long ago the last tick was, a search and no count.
  const double rounds = choice_.recording->repeats ? std::max(0.0, std::floor(time / round_)) : 0.0;
  const auto due =
      std::partition_point(images.begin(), images.end(), [&](const scene::RecordedImage& image) {
        return image.time - images.front().time + round_ * rounds <= time;
      });
  return static_cast<std::size_t>(rounds) * images.size() +
         static_cast<std::size_t>(due - images.begin());
}

void CameraFeed::post(double time, std::size_t image, const std::vector<Pose>& X_W) noexcept {
  ring_.draft().time = time;
  ring_.draft().image = image;
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
  if (was_new && !look(*oldest)) {
    ++result_.lost;
    ring_.pop();
    return true;
  }
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

bool CameraFeed::look(const Scenery& scenery) {
  const Pose X_CW = choice_.X_WC.inverse();
  for (std::size_t i = 0; i < X_C_.size(); ++i) X_C_[i] = composed(X_CW, scenery.X_W[i]);
  if (simulated_) {
    simulated_->take(X_C_, image_);
  } else {
    const scene::RecordingChoice& recording = *choice_.recording;
    try {
      percepts::read_depth_image(recording.images[scenery.image].file, camera_, recording.unit,
                                 image_);
    } catch (const SetupError&) {  // it is damaged behind its head, or no longer there
      return false;
    }
  }
  if (on_image_) on_image_({index_, scenery.time, camera_, image_});
  const auto begin = steady_clock::now();
  (void)own_.remove(X_C_, image_);
  maker_->look(image_, scenery.time);
  looking_ = steady_clock::now() - begin;
  has_looked_ = true;
  return true;
}

double CameraFeed::silent_for() const noexcept {
  const double age =
      now_.load(std::memory_order_relaxed) - seen_at_.load(std::memory_order_acquire);
  return age > choice_.silent_after ? age : 0.0;
}

ImageResult CameraFeed::result() const {
  ImageResult result = result_;
  result.lost += ring_.dropped() + skipped_;
  result.silent = silent_;
  return result;
}

}  // namespace repel::runs
