// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the cameras of a scene file, and what is known of recorded depth images.
#pragma once

#include <vector>

#include <repel/scene/camera.hpp>

#include "obstacle_reader.hpp"
#include "yaml.hpp"

namespace repel::scene::detail {

/// The one of `camera`, or those of `cameras`.
[[nodiscard]] std::vector<CameraChoice> cameras_of(const Map& scene, const Laws& laws);

}  // namespace repel::scene::detail
