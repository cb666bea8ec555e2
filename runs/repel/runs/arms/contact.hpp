// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of a scene that can collide physically.
#pragma once

#include <vector>

#include <repel/robots/urdf.hpp>
#include <repel/scene/scene.hpp>
#include <repel/simulated/contact.hpp>

namespace repel::runs {

/// The tool of `setup`, all parts of the moving links of its `robot`, and the obstacles of `scene`
/// that are not passable.
/// @throws SetupError naming an obstacle that moves: the back ends simulate fixed obstacles only
[[nodiscard]] std::vector<ContactPart> contact_parts(const scene::Scene& scene,
                                                     const scene::ArmSetup& setup,
                                                     const Robot& robot);

}  // namespace repel::runs
