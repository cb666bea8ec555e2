/// @file
/// The obstacles that a robot description is made into.
#pragma once

#include <string>
#include <vector>

#include <repel/scene/scene.hpp>

namespace repel::teleop {

/// The collision parts of `model`, where they stand in the world.
/// @param part_lists to which the paths of the lists of its parts are added
/// @throws SetupError naming file, line, value and what is allowed
[[nodiscard]] std::vector<scene::Obstacle> obstacles_of(const scene::StaticModel& model,
                                                        std::vector<std::string>& part_lists);

}  // namespace repel::teleop
