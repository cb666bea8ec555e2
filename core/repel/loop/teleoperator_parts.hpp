// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the control of one arm, and the check that the walls of the world act on the arm.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/loop/arm_bodies.hpp>
#include <repel/network/modules/puma_joints.hpp>
#include <repel/network/network.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// What couples one arm of a world to its operator. Referenced objects must outlive the
/// teleoperator.
struct TeleoperatorParts {
  const ArmModel& model;        ///< of the arm
  ArmKinematics& kinematics;    ///< at the start pose of the arm
  World& world;                 ///< shared by all arms
  BodyId tool;                  ///< moves with the tool frame
  std::vector<LinkBody> links;  ///< bodies whose forces act through the module ARM_OBSTACLE
  network::Network network;     ///< built for the period
};

namespace detail {

/// True when some pair of the world contains the body.
[[nodiscard]] inline bool has_pair(const World& world, BodyId body) {
  const auto pairs = world.pairs();
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return world.part(pair.a).body == body || world.part(pair.b).body == body;
  });
}

/// The name of the only module that applies these walls; empty when there is none.
/// @throws SetupError when there are two
[[nodiscard]] inline std::string module_for(const network::Network& network, network::Walls walls) {
  std::string name;
  for (const network::Node& node : network.nodes()) {
    if (node.traits.walls != walls) continue;
    if (!name.empty()) {
      throw SetupError("network: '" + name + "' and '" + node.name +
                       "' both bring the same walls, which would act twice; allowed: one of them");
    }
    name = node.name;
  }
  return name;
}

}  // namespace detail

/// Checks the parts. Set-up only: a wall that no module applies would not push the arm, although
/// the record of every tick would show its force.
/// @throws SetupError, naming what is missing, for: a network that does not end in the joints of
/// the arm, walls on the tool or on links with no module that applies them, and two that apply the
/// same
inline void require_complete(const TeleoperatorParts& parts) {
  const network::Network& network = parts.network;
  const int joints = static_cast<int>(parts.model.links.size());
  const auto* robot = network.find<network::PumaJoints>();
  if (robot == nullptr || robot->size() != joints) {
    throw SetupError("network: it ends in " +
                     (robot == nullptr
                          ? std::string("no robot")
                          : "a robot of " + std::to_string(robot->size()) + " joints") +
                     "; allowed: a robot (puma_joints) of " + std::to_string(joints) +
                     " joints, as many as the arm has");
  }
  if (detail::module_for(network, network::Walls::tool).empty() &&
      detail::has_pair(parts.world, parts.tool)) {
    throw SetupError(
        "network: there are obstacles for the tool and no module through which they act; allowed: "
        "one like 'obstacle', on the robot's side of the network");
  }
  const bool is_near =
      std::any_of(parts.links.begin(), parts.links.end(),
                  [&](const LinkBody& link) { return detail::has_pair(parts.world, link.body); });
  if (detail::module_for(network, network::Walls::links).empty() && is_near) {
    throw SetupError(
        "network: there are links to keep off the obstacles and no module through which they feel "
        "them; allowed: one like 'arm_obstacle', between puma_kin and the robot");
  }
}

}  // namespace repel
