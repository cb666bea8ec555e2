// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What becomes of the images of a camera.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <repel/percepts/depth_camera.hpp>
#include <repel/scene/scene.hpp>
#include <repel/schedule/world_changes.hpp>

namespace repel::runs {

/// An image as it was taken, the robot included.
struct CameraImage {
  std::size_t index = 0;  ///< of the camera in its scene
  double time = 0.0;      ///< [s]
  const percepts::DepthCamera& camera;
  std::span<const float> depth;  ///< [m]
};

/// Who is told what cameras do; either may be empty.
struct CameraListeners {
  std::function<void(PartId, const Shape&)> on_add{};  ///< see PerceivedOptions
  std::function<void(const CameraImage&)> on_image{};  ///< after each image
};

/// What of the running cell a camera is to have.
struct CameraPlace {
  std::size_t index = 0;            ///< in its scene
  WorldChanges* changes = nullptr;  ///< not null, outlives the camera
  ReservedShare share{};            ///< of the reserved parts, its own
  double period = 0.0;              ///< [s] of the tick
  CameraListeners listeners{};
};

/// What an image has changed.
struct MadeParts {
  int cells = 0;      ///< or boxes, that it needs
  int added = 0;      ///< of these, that have become a part
  int left_out = 0;   ///< of these, that have found none
  double cube = 0.0;  ///< [m] edge of the cubes of a map; 0: there is none
};

/// Makes parts of depth images, of which the robot was taken out. For one thread.
class PartMaker {
 public:
  virtual ~PartMaker() = default;
  PartMaker(const PartMaker&) = delete;
  PartMaker& operator=(const PartMaker&) = delete;

  /// Takes an image over. @param depth [m] may be changed @param time [s] of the image
  virtual void look(std::span<float> depth, double time) = 0;
  /// Makes parts of the image that was looked at last.
  virtual MadeParts make() = 0;

 protected:
  PartMaker() = default;
};

/// Cells of each image, or with `map` boxes of all images together.
/// @throws SetupError for a camera with a map, if this build has none
[[nodiscard]] std::unique_ptr<PartMaker> make_part_maker(const scene::CameraChoice& choice,
                                                         const percepts::DepthCamera& camera,
                                                         const CameraPlace& place);

}  // namespace repel::runs
