// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A depth camera on a running cell, simulated or recorded, and the parts made of its images.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/ring.hpp>
#include <repel/common/deadline.hpp>
#include <repel/percepts/own_body.hpp>
#include <repel/percepts/simulated_camera.hpp>
#include <repel/runs/cameras/part_maker.hpp>
#include <repel/runs/cameras/sights.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// Counts of the images of a camera.
struct ImageResult {
  std::string name;           ///< of the camera
  std::int64_t images = 0;    ///< of which parts were made
  std::int64_t lost = 0;      ///< too fast to be used, or damaged
  int most_cells = 0;         ///< or boxes, of an image
  double largest_cube = 0.0;  ///< [m] of a map; 0: there is none
  std::int64_t left_out = 0;  ///< cells for which no reserved part was free, over all images
  std::int64_t made = 0;      ///< parts made, over all images
  double silent = 0.0;        ///< [s] time in which the camera counted as silent
  DurationHistogram compute;  ///< from an image to its parts, without drawing the image
};

/// Takes images of a running cell and makes parts of them. One thread follows the cell, one makes
/// the parts; they may be the same.
class CameraFeed {
 public:
  CameraFeed(const scene::CameraChoice& choice, const Sights& sights, const CameraPlace& place);

  /// After every tick, at `time` [s]; never waits. @param X_W [m] of all sights @param elapsed [s]
  /// since the last one @param is_blind the camera gives no image now
  void follow(double time, const std::vector<Pose>& X_W, bool is_blind) noexcept;
  /// Of the same thread, after the image of this tick was served, if it is: counts the time in
  /// which the camera is silent. @param elapsed [s] since the last tick
  void count_silence(double elapsed) noexcept;
  /// [s] Age of the last image made into parts, if the camera counts as silent, otherwise 0. Of the
  /// thread of the tick.
  [[nodiscard]] double silent_for() const noexcept;

  /// Makes parts of an image that is due. @param early looks at an image before its time
  /// @return whether there was something to do
  bool serve(bool early);
  /// After the serving thread has ended.
  [[nodiscard]] ImageResult result() const;

 private:
  struct Scenery {
    double time = 0.0;      ///< [s]
    std::size_t image = 0;  ///< of a recording
    std::vector<Pose> X_W;
  };

  void post(double time, std::size_t image, const std::vector<Pose>& X_W) noexcept;
  void follow_recording(double time, const std::vector<Pose>& X_W, bool is_blind) noexcept;
  /// How many images of the recording are due until then [s], counted through all repetitions.
  [[nodiscard]] std::size_t due_until(double time) const noexcept;
  /// False if the image cannot be read.
  [[nodiscard]] bool look(const Scenery& scenery);

  const scene::CameraChoice choice_;
  percepts::DepthCamera camera_;
  std::optional<percepts::SimulatedCamera> simulated_;  ///< none: the images are recorded
  percepts::OwnBody own_;
  std::unique_ptr<PartMaker> maker_;
  std::vector<float> image_;
  std::vector<Pose> X_C_;    ///< [m] in the frame of the camera
  bool has_looked_ = false;  ///< at the oldest image in the ring
  Ring<Scenery> ring_;
  double next_ = 0.0;           ///< [s] when the next image is due
  std::size_t next_image_ = 0;  ///< of a recording, counted through all repetitions
  double round_ = 0.0;          ///< [s] after which the recording begins again, if it does
  std::atomic<double> now_{0.0};
  std::atomic<double> seen_at_{0.0};  ///< [s] capture time of the last image used
  double period_ = 0.0;               ///< [s] of the tick
  std::size_t index_;                 ///< in its scene
  std::function<void(const CameraImage&)> on_image_;
  std::chrono::nanoseconds looking_{0};  ///< at the oldest image in the ring
  ImageResult result_;                   ///< of the serving thread, but for:
  double silent_ = 0.0;                  ///< [s] of the thread of the tick
  std::int64_t skipped_ = 0;             ///< images, of the thread of the tick
};

}  // namespace repel::runs
