// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Names of the parts of a run, for logs and displays.
#pragma once

#include <string>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// Names of an arm, its network and its script.
struct ArmHeading {
  std::string name;  ///< of the partner; empty for the arm of the scene itself
  BodyId tool;
  std::vector<BodyId> links;      ///< those with parts
  std::vector<JointType> joints;  ///< base outward
  std::vector<std::string> joint_names;
  std::vector<std::string> modules;  ///< of the network, in its order
  std::vector<std::string> phases;   ///< of the script

  /// Prefix of its column names: "left/", or empty.
  [[nodiscard]] std::string prefix() const { return name.empty() ? name : name + '/'; }
};

struct Heading {
  std::vector<ArmHeading> arms;
  std::vector<std::string> bodies;  ///< by BodyId
  std::vector<std::string> pairs;   ///< "part - obstacle", by PairId
  std::vector<std::string> cameras;
};

/// "part - obstacle".
[[nodiscard]] std::string name_of(const World& world, PairId pair);

/// Builds the names for a scene and the cell built from it.
[[nodiscard]] Heading heading_of(const scene::Scene& scene, const Cell& cell);

}  // namespace repel::runs
