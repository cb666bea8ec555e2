// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Takes the robot out of depth images.
#pragma once

#include <span>
#include <vector>

#include <repel/percepts/depth_camera.hpp>
#include <repel/reduction/shape.hpp>

namespace repel::percepts {

/// Removes the robot itself from camera images: every pixel with its point in one of the robot's
/// parts, their faces moved out by a margin. Allocates at construction only.
class OwnBody {
 public:
  /// @param shapes of the parts of tool and links @param margin [m] 0 to 1: how far model, readings
  /// and camera may be wrong together
  /// @throws SetupError for a margin out of range
  OwnBody(const DepthCamera& camera, std::vector<Shape> shapes, double margin = 0.03);

  /// Negates the depth of such pixels: not measured, and see DepthMemory. @param X_CP [m] the parts
  /// in the frame of the camera when the image was taken, in their order @return the number of
  /// pixels. Cost: about 30 ns for each pixel in the rectangle around a part and each of its planes
  int remove(std::span<const Pose> X_CP, std::span<float> depth) const noexcept;

 private:
  [[nodiscard]] int remove(const Shape& shape, const Pose& X_CP,
                           std::span<float> depth) const noexcept;

  DepthCamera camera_;
  std::vector<Shape> shapes_;
  double margin_;  ///< [m]
};

}  // namespace repel::percepts
