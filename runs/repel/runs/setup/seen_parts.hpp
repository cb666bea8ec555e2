// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of a cell reserved for cameras.
#pragma once

#include <string>

#include <repel/scene/scene.hpp>

namespace repel::runs {

/// [m] Largest reach of a part that is made of an image.
constexpr double room_of_seen = 1.1;

/// The name of the parts that are made of the images of a camera.
[[nodiscard]] inline std::string name_of_seen(const scene::CameraChoice& camera) {
  return camera.name.empty() ? "seen" : "seen_" + camera.name;
}

}  // namespace repel::runs
