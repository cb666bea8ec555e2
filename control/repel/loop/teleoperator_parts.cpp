// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/teleoperator_parts.hpp>

#include <algorithm>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules/puma_joints.hpp>

namespace repel::detail {

bool has_pair(const World& world, BodyId body) {
  const auto pairs = world.pairs();
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return world.part(pair.a).body == body || world.part(pair.b).body == body;
  });
}

std::string module_for(const network::Network& network, network::Walls walls) {
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

}  // namespace repel::detail

namespace repel {

void require_complete(const TeleoperatorParts& parts) {
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
