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

/// The parts coupling one arm of a world to its operator. Referenced objects must outlive the
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

/// The name of the module applying these walls; empty: none. @throws SetupError for two
[[nodiscard]] std::string module_for(const network::Network& network, network::Walls walls);

}  // namespace detail

/// Checks the parts. Set-up only: without a module applying it, a wall would not push the arm, yet
/// the record of every tick would show its force. @throws SetupError, naming the missing part, for:
/// a network not ending in the joints of the arm, walls on the tool or on links without a module
/// applying them, and two modules for the same walls
void require_complete(const TeleoperatorParts& parts);

}  // namespace repel
