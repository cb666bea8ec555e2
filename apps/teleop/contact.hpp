/// @file
/// What can touch in a scene.
#pragma once

#include <vector>

#include <repel/robots/urdf.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/contact.hpp>

namespace repel::teleop {

/// The tool of `station`, all parts of the moving links of its `robot`, and the obstacles of
/// `scene` that are not passable.
/// @throws SetupError naming an obstacle that moves: those of simulated arms stand
[[nodiscard]] std::vector<ContactPart> contact_parts(const scene::Scene& scene,
                                                     const scene::Station& station,
                                                     const Robot& robot);

}  // namespace repel::teleop
