/// @file
/// A scene made ready to run: the robot and the world.
#pragma once

#include <vector>

#include <repel/robots/kinematics.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/world.hpp>

namespace repel::teleop {

/// Owns everything of a scene but the arm itself, whose type is the back end's.
struct Cell {
  /// @param with_gravity false for a back end without gravity, so that none is compensated
  /// @throws SetupError for a scene or robot file that cannot be taken whole
  Cell(const scene::Scene& scene, bool with_gravity);

  /// The least viscous damping of the arm at its tool, where it starts [N s/m].
  [[nodiscard]] double device_damping();

  ArmModel model;
  std::vector<double> start;  ///< [rad]
  Kinematics kinematics;
  BodyId tool;
  World world;
};

}  // namespace repel::teleop
