/// @file
/// What a scene describes, built: its arms, and the world of their tools, links and obstacles.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <repel/loop/shuttle.hpp>
#include <repel/loop/tick.hpp>
#include <repel/robots/kinematics.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/world.hpp>

namespace repel::teleop {

/// An arm of the cell, with its tool and links as bodies of the world.
struct Manipulator {
  /// Adds its bodies and parts to `world`, their names behind `prefix`.
  /// @throws SetupError naming file, value and what is allowed
  Manipulator(const scene::Scene& scene, const scene::Station& station, const std::string& prefix,
              bool with_gravity, World& world);

  /// The least viscous damping of the arm at its tool, where it starts [N s/m].
  [[nodiscard]] double device_damping();

  Robot robot;
  std::vector<double> start;  ///< [rad]
  Kinematics kinematics;
  BodyId tool;
  std::vector<LinkBody> links;          ///< those of the arm's links that have parts
  std::vector<PartId> parts;            ///< of the tool, then of the links, base outward
  std::vector<std::string> part_links;  ///< the link of the file that each is on
};

/// The arms where they start, and a world in which tools and links are kept off every obstacle,
/// off each other's arm and, where the scene says so, off the other parts of their own.
struct Cell {
  /// @param with_gravity false for arms that weigh nothing
  /// @throws SetupError naming file, value and what is allowed
  Cell(const scene::Scene& scene, bool with_gravity);

  /// The least viscous damping of any arm at its tool, where it starts [N s/m].
  [[nodiscard]] double device_damping();

  /// A sentence for each solid pair whose parts overlap where the arms start, by more than touch.
  [[nodiscard]] std::vector<std::string> overlaps() const;

  /// Throws SetupError with what overlaps, unless nothing does or the scene has it pushed out.
  void require_clear_start(const scene::Scene& scene) const;

  /// The arm of the scene itself; its partners follow it in `arms`.
  [[nodiscard]] Manipulator& arm() noexcept { return arms.front(); }

  World world;
  std::deque<Manipulator> arms;
  std::vector<Shuttle> shuttles;  ///< of the obstacles that move by themselves
};

}  // namespace repel::teleop
