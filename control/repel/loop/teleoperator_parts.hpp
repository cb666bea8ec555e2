// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the control of one arm, and the check that the walls of the world act on the arm.
#pragma once

#include <string>
#include <vector>

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
[[nodiscard]] bool has_pair(const World& world, BodyId body);

/// The name of the only module that applies these walls; empty when there is none.
/// @throws SetupError when there are two
[[nodiscard]] std::string module_for(const network::Network& network, network::Walls walls);

}  // namespace detail

/// Checks the parts. Set-up only: a wall that no module applies would not push the arm, although
/// the record of every tick would show its force.
/// @throws SetupError, naming what is missing, for: a network that does not end in the joints of
/// the arm, walls on the tool or on links with no module that applies them, and two that apply the
/// same
void require_complete(const TeleoperatorParts& parts);

}  // namespace repel
