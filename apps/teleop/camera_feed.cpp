#include "camera_feed.hpp"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/robots/parts.hpp>

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

percepts::CellOptions cells_of(const scene::CameraChoice& choice) {
  percepts::CellOptions options;
  options.most = choice.parts / 2;  // what is new comes before what it replaces goes
  options.room = room_of_seen - 0.1;
  if (choice.is_unseen_solid) options.thickness = options.room;
  // Twice the blocks to begin with must be within `most`.
  const auto blocks = [&] {
    return ((choice.width - 1) / options.largest + 1) * ((choice.height - 1) / options.largest + 1);
  };
  while (2 * blocks() > options.most) options.largest *= 2;
  return options;
}

std::size_t images_waiting(const scene::CameraChoice& choice) {
  return static_cast<std::size_t>(std::ceil(choice.latency * choice.rate_hz)) + 2;
}

Pose nowhere() {
  Pose X = Pose::Identity();
  X.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
  return X;
}

percepts::PerceivedOptions perceived(std::function<void(PartId, const Shape&)> on_add) {
  percepts::PerceivedOptions options;
  options.on_add = std::move(on_add);
  return options;
}

}  // namespace

Sights::Sights(const scene::Scene& scene, const std::vector<Robot>& robots, const Cell& cell)
    : cell_(cell) {
  for (std::size_t arm = 0; arm < robots.size(); ++arm) {
    const scene::ArmSetup& setup = scene.arm_setup(arm);
    kinematics_.emplace_back(cell.description().arms[arm].model);
    joints_.push_back(cell.description().arms[arm].model.links.size());
    const int index = static_cast<int>(arm);
    for (const scene::Part& part : setup.tool) {
      sights_.push_back(
          {.name = part.name, .shape = part.shape, .X = part.X_BP, .arm = index, .is_tool = true});
    }
    for (const RobotPart& part : robots[arm].parts) {
      sights_.push_back({.name = part.name,
                         .shape = shape_of(part, {.levels = 1}),
                         .X = part.X_LP,
                         .arm = index,
                         .link = part.link});
    }
  }
  for (const ObstacleDescription& each : cell.description().obstacles) {
    sights_.push_back(
        {.name = each.name, .shape = each.shape, .X = each.X_WP, .motion = each.motion});
  }
  for (std::size_t i = 0; i < scene.loose.size(); ++i) {
    const scene::LoosePart& part = scene.loose[i];
    sights_.push_back({.name = part.name, .shape = part.shape, .loose = cell.loose()[i]});
  }
  for (const scene::HiddenPart& part : scene.hidden) {
    sights_.push_back({.name = part.name,
                       .shape = part.shape,
                       .X = part.X_WP,
                       .is_hidden = true,
                       .motion = part.motion});
  }
}

Pose Sights::pose_of(const Sight& sight, double time) const noexcept {
  if (sight.arm >= 0) {
    const Kinematics& arm = kinematics_[static_cast<std::size_t>(sight.arm)];
    return composed(sight.is_tool ? arm.X_WT() : arm.X_WL(sight.link), sight.X);
  }
  if (sight.loose.valid()) {
    const World& world = cell_.world();
    const auto body = static_cast<std::size_t>(world.part(sight.loose).body.index);
    return world.is_there(sight.loose) ? world.motion().bodies[body].X_WB : nowhere();
  }
  Pose X = sight.X;
  if (sight.motion) X.translation() += sight.motion->offset(time);
  return X;
}

void Sights::place(std::span<const TickRecord* const> records, std::vector<Pose>& X_W) noexcept {
  for (std::size_t i = 0; i < std::min(records.size(), kinematics_.size()); ++i) {
    kinematics_[i].update(std::span(records[i]->q).first(joints_[i]));
  }
  for (std::size_t i = 0; i < std::min(sights_.size(), X_W.size()); ++i) {
    X_W[i] = pose_of(sights_[i], records.front()->time);
  }
}

std::vector<TriangleMesh> Sights::meshes() const {
  std::vector<TriangleMesh> meshes;
  for (const Sight& sight : sights_) meshes.push_back(mesh_of(sight.shape));
  return meshes;
}

std::vector<Shape> Sights::known() const {
  std::vector<Shape> shapes;
  for (const Sight& sight : sights_) {
    if (!sight.is_hidden) shapes.push_back(sight.shape);
  }
  return shapes;
}

void Sights::measure(const std::vector<Pose>& X_W, CameraResult& result) const {
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const Sight& of_arm = sights_[i];
    if (of_arm.arm < 0 || of_arm.link < 0) continue;
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      if (!sights_[k].is_hidden) continue;
      const Separation s = separation(of_arm.shape, X_W[i], sights_[k].shape, X_W[k],
                                      {.ignore_beyond = result.least_clearance});
      if (!(s.distance < result.least_clearance)) continue;
      result.least_clearance = s.distance;
      result.nearest_pair = of_arm.name + " - " + sights_[k].name;
    }
  }
}

CameraFeed::CameraFeed(const scene::Scene& scene, const std::vector<Robot>& robots, Cell& cell,
                       bool in_step, std::function<void(PartId, const Shape&)> on_add)
    : choice_(*scene.camera),
      camera_(camera_of(choice_)),
      sights_(scene, robots, cell),
      simulated_(camera_, sights_.meshes(),
                 {.noise = choice_.noise, .lost = choice_.lost, .seed = choice_.seed}),
      own_(camera_, sights_.known(), choice_.margin),
      memory_(camera_),
      division_(camera_, cells_of(choice_)),
      parts_(cell.changes(), perceived(std::move(on_add))),
      image_(camera_.pixels()),
      X_C_(sights_.size(), Pose::Identity()),
      X_W_(sights_.size(), Pose::Identity()),
      ring_(images_waiting(choice_), Scenery{0.0, X_W_}),
      period_(1e-9 * static_cast<double>(cell.period().count())),
      in_step_(in_step) {
  if (in_step_) return;
  thread_ = std::jthread([this](const std::stop_token& stopped) {
    (void)pthread_setname_np(pthread_self(), "repel camera");
    while (!stopped.stop_requested()) {
      if (!serve()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
}

void CameraFeed::follow(std::span<const TickRecord* const> records, bool is_blind) {
  const double time = records.front()->time;
  now_.store(time, std::memory_order_release);
  sights_.place(records, X_W_);
  sights_.measure(X_W_, result_);
  // Half a tick early or late, so that images are equally spaced whatever the rates are.
  if (time >= next_ - 0.5 * period_) {
    next_ = std::max(next_ + 1.0 / choice_.rate_hz, time);
    if (!is_blind) {
      ring_.draft().time = time;
      ring_.draft().X_W = X_W_;
      (void)ring_.post();
    }
  }
  if (in_step_) {
    while (serve()) continue;
  }
  if (silent_for() > 0.0) result_.silent += period_ * static_cast<double>(records.front()->elapsed);
}

bool CameraFeed::serve() {
  const Scenery* const oldest = ring_.front();
  if (oldest == nullptr) return false;
  const bool was_new = !has_looked_;
  if (was_new) look(*oldest);
  const double now = now_.load(std::memory_order_acquire);
  if (now < oldest->time + choice_.latency - 0.5 * period_) return was_new && !in_step_;
  const auto begin = steady_clock::now();
  const percepts::PerceptCounts counts = parts_.see(cells_, division_, choice_.X_WC, oldest->time);
  result_.compute.record(looking_ + (steady_clock::now() - begin));
  ++result_.images;
  result_.most_cells = std::max(result_.most_cells, counts.cells);
  result_.left_out += counts.left_out;
  result_.made += counts.added;
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
  (void)memory_.fill(image_, scenery.time);
  cells_ = division_.divide(image_);
  looking_ = steady_clock::now() - begin;
  has_looked_ = true;
}

double CameraFeed::silent_for() const noexcept {
  const double age =
      now_.load(std::memory_order_relaxed) - seen_at_.load(std::memory_order_acquire);
  return age > choice_.silent_after ? age : 0.0;
}

void CameraFeed::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  result_.lost = ring_.dropped();
}

}  // namespace repel::teleop
