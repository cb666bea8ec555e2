/// @file
/// What the parts of a run are called: for logs and displays.
#pragma once

#include <string>
#include <vector>

#include <repel/scene/scene.hpp>
#include <repel/world/world.hpp>

namespace repel::teleop {

struct Cell;

/// An arm, its network and its script.
struct ArmHeading {
  std::string name;  ///< of the partner; empty for the arm of the scene itself
  BodyId tool;
  std::vector<BodyId> links;         ///< that have parts
  std::vector<JointType> joints;     ///< base outward
  std::vector<std::string> modules;  ///< of the network, in its order
  std::vector<std::string> phases;   ///< of the script

  /// What stands before the names of its columns: "left/", or nothing.
  [[nodiscard]] std::string prefix() const { return name.empty() ? name : name + '/'; }
};

struct Heading {
  std::vector<ArmHeading> arms;
  std::vector<std::string> bodies;  ///< by BodyId
  std::vector<std::string> pairs;   ///< "part - obstacle", by PairId
};

/// "part - obstacle".
[[nodiscard]] std::string name_of(const World& world, PairId pair);

/// Of a scene and the cell that was built from it.
[[nodiscard]] Heading heading_of(const scene::Scene& scene, const Cell& cell, double rate_hz);

}  // namespace repel::teleop
