/// @file
/// Whether a network brings the walls of a world to the arm that it drives.
#pragma once

#include <algorithm>
#include <span>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/loop/arm_bodies.hpp>
#include <repel/network/network.hpp>
#include <repel/network/puma_joints.hpp>
#include <repel/world/world.hpp>

namespace repel {

namespace detail {

/// True when something in the world pushes the body.
[[nodiscard]] inline bool has_pair(const World& world, BodyId body) {
  const auto pairs = world.pairs();
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return world.part(pair.a).body == body || world.part(pair.b).body == body;
  });
}

/// The name of the only module that brings these walls; empty when there is
/// none.
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

/// Set-up only: a wall that nothing brings to the arm pushes nobody, and the record of every tick
/// would still have its force.
/// @param links bodies of the world that are links of the arm
/// @throws SetupError, naming what is missing, for: a network that does not end in `joints` joints,
/// walls on the tool or on links with no module that brings them, and two that bring the same
inline void require_complete(const network::Network& network, int joints, const World& world,
                             BodyId tool, std::span<const LinkBody> links) {
  const auto* robot = network.find<network::PumaJoints>();
  if (robot == nullptr || robot->size() != joints) {
    throw SetupError("network: it ends in " +
                     (robot == nullptr
                          ? std::string("no robot")
                          : "a robot of " + std::to_string(robot->size()) + " joints") +
                     "; allowed: a robot (puma_joints) of " + std::to_string(joints) +
                     " joints, as many as the arm has");
  }
  if (detail::module_for(network, network::Walls::tool).empty() && detail::has_pair(world, tool)) {
    throw SetupError(
        "network: there are obstacles for the tool and no module through which they act; allowed: "
        "one like 'obstacle', on the robot's side of the network");
  }
  const bool is_near = std::any_of(links.begin(), links.end(), [&](const LinkBody& link) {
    return detail::has_pair(world, link.body);
  });
  if (detail::module_for(network, network::Walls::links).empty() && is_near) {
    throw SetupError(
        "network: there are links to keep off the obstacles and no module through which they feel "
        "them; allowed: one like 'arm_obstacle', between puma_kin and the robot");
  }
}

}  // namespace repel
