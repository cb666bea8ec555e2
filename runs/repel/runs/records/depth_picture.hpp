// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The image of a depth camera as a recording shows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace repel::runs {

/// In a recording an image has this many pixels at most.
inline constexpr int most_picture_pixels = 320 * 240;

/// A depth image to the millimetre, with every n-th row and column of what the camera took.
struct DepthPicture {
  std::size_t camera = 0;  ///< of Scene::cameras
  double time = 0.0;       ///< [s] when it was taken
  int width = 0;           ///< [px]
  int height = 0;          ///< [px]
  /// [mm] Row by row, 65535 for what is farther; 0: nothing was measured.
  std::vector<std::uint16_t> depth;
};

/// With the smallest n for `most_picture_pixels`.
/// @param depth [m] row by row; zero, negative or not finite: nothing was measured
[[nodiscard]] DepthPicture depth_picture(std::size_t camera, double time, int width, int height,
                                         std::span<const float> depth);

}  // namespace repel::runs
