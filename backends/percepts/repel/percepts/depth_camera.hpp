// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A camera that measures depth.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <repel/base/layout.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/base/types.hpp>

namespace repel::percepts {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// A pinhole camera without distortion. Its frame C, as in ROS: x to the right of the image, y
/// down, z along the optical axis. The centre of the pixel in column u and row v is at (u, v). A
/// depth is the coordinate z [m] of what is seen; zero, negative or not finite: nothing was
/// measured. An image has its rows one after the other.
struct DepthCamera {
  int width = 320;        ///< [px]
  int height = 240;       ///< [px]
  double fx = 280.0;      ///< [px] focal length across
  double fy = 280.0;      ///< [px] focal length down
  double cx = 159.5;      ///< [px] column where the optical axis meets the image
  double cy = 119.5;      ///< [px] row, likewise
  double nearest = 0.1;   ///< [m] nearer depths are no measurements
  double farthest = 5.0;  ///< [m] nor are farther ones

  /// Number of pixels of an image.
  [[nodiscard]] std::size_t pixels() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// The place of a pixel in an image.
  [[nodiscard]] std::size_t at(int u, int v) const noexcept {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(u);
  }
  /// The ray through an image point, with z = 1.
  [[nodiscard]] Vec3 ray(double u, double v) const noexcept {
    return {(u - cx) / fx, (v - cy) / fy, 1.0};
  }
  /// A depth within the range; false for one that is not a number.
  [[nodiscard]] bool measures(float depth) const noexcept {
    return depth >= static_cast<float>(nearest) && depth <= static_cast<float>(farthest);
  }
};

/// Returns `camera`. @throws SetupError naming the number that is out of range
inline const DepthCamera& checked(const DepthCamera& camera) {
  repel::checked("width of the image", camera.width, 1.0, 8192.0, "px");
  repel::checked("height of the image", camera.height, 1.0, 8192.0, "px");
  for (const double f : {camera.fx, camera.fy}) {
    repel::checked("focal length", f, 1.0, 1e6, "px");
  }
  for (const double c : {camera.cx, camera.cy}) {
    repel::checked("centre of the image", c, -1e6, 1e6, "px");
  }
  repel::checked("nearest depth", camera.nearest, 1e-3, 100.0, "m");
  repel::checked("farthest depth", camera.farthest, camera.nearest, 1000.0, "m");
  return camera;
}

}  // namespace repel::percepts
