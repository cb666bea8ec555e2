// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The obstacles that a robot description or an SDF file is made into.
#pragma once

#include <string>
#include <vector>

#include <repel/runs/setup/covers_beside.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// The collision parts of `model`, where they stand in the world.
/// @param covers for its meshes, if the model takes them
/// @throws SetupError naming file, line, value and what is allowed
[[nodiscard]] std::vector<scene::Obstacle> obstacles_of(const scene::StaticModel& model,
                                                        CoversBeside& covers);

}  // namespace repel::runs
