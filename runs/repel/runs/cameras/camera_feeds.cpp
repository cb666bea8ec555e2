// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/cameras/camera_feeds.hpp>

#include <pthread.h>

#include <algorithm>
#include <chrono>

namespace repel::runs {
namespace {

/// Whether a phase of a script that is being played makes a camera silent.
bool is_blind(const scene::Scene& scene, std::span<const TickRecord* const> records,
              std::size_t camera) noexcept {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::vector<std::vector<bool>>& phases = scene.arm_setup(i).blind;
    const auto phase = static_cast<std::size_t>(records[i]->phase);
    if (phase >= phases.size()) continue;
    if (camera < phases[phase].size() && phases[phase][camera]) return true;
  }
  return false;
}

}  // namespace

CameraFeeds::CameraFeeds(const scene::Scene& scene, const std::vector<Robot>& robots, Cell& cell,
                         bool in_step, const CameraListeners& listeners)
    : sights_(scene, robots, cell),
      X_W_(sights_.size(), Pose::Identity()),
      period_(1e-9 * static_cast<double>(cell.period().count())),
      in_step_(in_step) {
  // Their parts follow those of the scene itself, camera by camera.
  std::size_t first = scene.loose.size() + static_cast<std::size_t>(scene.spare.count);
  for (const scene::CameraChoice& choice : scene.cameras) {
    const auto count = static_cast<std::size_t>(choice.parts);
    feeds_.push_back(
        std::make_unique<CameraFeed>(choice, sights_,
                                     CameraPlace{.index = feeds_.size(),
                                                 .changes = &cell.changes(),
                                                 .share = {.first = first, .count = count},
                                                 .period = period_,
                                                 .listeners = listeners}));
    first += count;
  }
  if (in_step_) return;
  thread_ = std::jthread([this](const std::stop_token& stopped) {
    (void)pthread_setname_np(pthread_self(), "repel camera");
    while (!stopped.stop_requested()) {
      if (!serve_each()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
}

void CameraFeeds::follow(const scene::Scene& scene, std::span<const TickRecord* const> records) {
  const double time = records.front()->time;
  sights_.place(records, X_W_);
  sights_.measure(X_W_, clearance_);
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    feeds_[i]->follow(time, X_W_, is_blind(scene, records, i));
  }
  if (in_step_) {
    while (serve_each()) continue;
  }
  const double elapsed = period_ * static_cast<double>(records.front()->elapsed);
  for (const auto& feed : feeds_) feed->count_silence(elapsed);
  if (silent_for() > 0.0) silent_ += elapsed;
}

bool CameraFeeds::serve_each() {
  bool was_busy = false;
  for (const auto& feed : feeds_) was_busy = feed->serve(!in_step_) || was_busy;
  return was_busy;
}

double CameraFeeds::silent_for() const noexcept {
  double longest = 0.0;
  for (const auto& feed : feeds_) longest = std::max(longest, feed->silent_for());
  return longest;
}

void CameraFeeds::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

CameraResult CameraFeeds::finish() {
  stop();
  CameraResult result;
  for (const auto& feed : feeds_) {
    const ImageResult& each = result.each.emplace_back(feed->result());
    result.all.images += each.images;
    result.all.lost += each.lost;
    result.all.most_cells = std::max(result.all.most_cells, each.most_cells);
    result.all.largest_cube = std::max(result.all.largest_cube, each.largest_cube);
    result.all.left_out += each.left_out;
    result.all.made += each.made;
    result.all.compute.add(each.compute);
  }
  result.all.silent = silent_;
  result.clearance = clearance_;
  return result;
}

}  // namespace repel::runs
