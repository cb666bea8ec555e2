// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Remembers what a depth camera has seen.
#pragma once

#include <span>
#include <vector>

#include <repel/percepts/depth_camera.hpp>

namespace repel::percepts {

/// Fills in pixels without a depth with what was last seen there. Where `OwnBody` has taken the
/// robot out, until something is measured, since a thing does not go away while the robot stands
/// before it. Elsewhere for a while, unless all depths measured around the pixel differ: then the
/// object has moved on. Allocates at construction only.
class DepthMemory {
 public:
  /// @param keeps [s] how long a depth is remembered where nothing is measured; 0 to 1e6
  /// @throws SetupError for a number out of range
  explicit DepthMemory(const DepthCamera& camera, double keeps = 2.0);

  /// Takes over an image at `time` [s], and fills it in. @param depth [m] width x height of the
  /// camera; a shorter one stays as it is @return pixels filled in. Cost: about 2 ns a pixel, 20 ns
  /// one that is lost
  int fill(std::span<float> depth, double time) noexcept;
  /// Forgets everything, as when the camera has moved.
  void forget() noexcept;

 private:
  [[nodiscard]] bool is_likely(std::span<const float> depth, std::size_t at,
                               float z) const noexcept;

  DepthCamera camera_;
  double keeps_;               ///< [s]
  std::vector<float> depths_;  ///< [m] last seen; 0: never
  std::vector<double> times_;  ///< [s] when
};

}  // namespace repel::percepts
