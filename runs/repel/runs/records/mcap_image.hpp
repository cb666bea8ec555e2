// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Depth images as messages foxglove.RawImage.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include <repel/runs/records/depth_picture.hpp>

namespace repel::runs::mcap {

/// @param frame of the camera, as in /poses
[[nodiscard]] nlohmann::json image_json(const DepthPicture& picture, const std::string& frame,
                                        std::uint64_t taken_ns);

}  // namespace repel::runs::mcap
