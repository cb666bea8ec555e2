// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Converts a scene to the description of a cell.
#pragma once

#include <vector>

#include <repel/cell/description.hpp>
#include <repel/network/remote/link.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// The cell of a scene, and the robots of its arms, in the order of the arms.
struct DescribedScene {
  CellDescription cell;
  std::vector<Robot> robots;
  std::vector<scene::Obstacle> model_obstacles;  ///< of Scene::models, the last ones of the cell
  /// Paths of the lists of parts of meshes in URDF files.
  std::vector<std::string> part_lists;
  /// Of each part of the world, in its order, without those reserved at its end.
  std::vector<scene::Shown> shown;
};

/// Reads the robots of the scene and describes its cell, with `rate_hz` ticks per second.
/// @param with_gravity false for arms without weight, as those of the back end "ideal"
/// @param remote link to the operator: the network of the cell is the half of the robot; null: it
/// is whole
/// @throws SetupError naming file, value and allowed values
[[nodiscard]] DescribedScene describe(const scene::Scene& scene, double rate_hz,
                                      bool with_gravity = true,
                                      network::RemoteLink* remote = nullptr);

}  // namespace repel::runs
