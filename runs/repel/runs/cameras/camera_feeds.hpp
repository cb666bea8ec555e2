// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// All cameras of a running cell.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include <repel/runs/cameras/camera_feed.hpp>

namespace repel::runs {

/// Counts of the images of a run.
struct CameraResult {
  ImageResult all;                ///< of all cameras: sums, or the greatest for maxima
  std::vector<ImageResult> each;  ///< in their order
  Clearance clearance;
};

/// Takes images of a running cell and makes parts of them. A run by the clock does so on one thread
/// for all cameras, in turns, as only one thread may ask for changes of the world. Other runs do so
/// between the ticks, to be repeatable.
class CameraFeeds {
 public:
  /// @param scene with cameras @param cell must outlive this object
  /// @param in_step between the ticks @param listeners called where the parts are made
  CameraFeeds(const scene::Scene& scene, const std::vector<Robot>& robots, Cell& cell, bool in_step,
              const CameraListeners& listeners);
  ~CameraFeeds() { stop(); }
  CameraFeeds(const CameraFeeds&) = delete;
  CameraFeeds& operator=(const CameraFeeds&) = delete;

  /// After every tick, outside of its time. By the clock it never waits.
  /// @param scene with the blind cameras of each phase
  void follow(const scene::Scene& scene, std::span<const TickRecord* const> records);
  /// [s] Greatest age over the cameras of the last image made into parts, if that camera counts as
  /// silent, otherwise 0. Of the thread of the tick.
  [[nodiscard]] double silent_for() const noexcept;
  /// Ends the thread. Then what has become of the images.
  [[nodiscard]] CameraResult finish();

 private:
  void stop();
  bool serve_each();

  Sights sights_;
  std::vector<std::unique_ptr<CameraFeed>> feeds_;
  std::vector<Pose> X_W_;  ///< [m] at the last tick
  Clearance clearance_;
  double period_;        ///< [s] of the tick
  double silent_ = 0.0;  ///< [s] in which a camera was
  bool in_step_;
  std::jthread thread_;
};

}  // namespace repel::runs
