// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads depth images that somebody has recorded.
#pragma once

#include <span>
#include <string>

#include <repel/percepts/depth_camera.hpp>

namespace repel::percepts {

/// Whether this build can read such files: it was built with libpng.
[[nodiscard]] bool reads_depth_images() noexcept;

/// Looks at the head of a PNG file, but for its pixels. It has to have one channel of 16 bits, and
/// the size of the images of `camera`.
/// @throws SetupError naming the file and what it has instead; also if this build cannot read it
void check_depth_image(const std::string& path, const DepthCamera& camera);

/// Reads such a file, by the convention of ROS and of the RGB-D benchmark of TUM: every pixel is a
/// multiple of a unit, 0 without a measurement.
/// @param unit [m] of a pixel, such as 0.001 @param depth [m] width x height of the camera, is
/// overwritten. Cost: some ms for 640 x 480
/// @throws SetupError as above, and for a file that is cut off or damaged
void read_depth_image(const std::string& path, const DepthCamera& camera, double unit,
                      std::span<float> depth);

}  // namespace repel::percepts
