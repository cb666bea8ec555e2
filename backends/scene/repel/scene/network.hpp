// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The network of an arm, as a scene file lists it.
#pragma once

#include <string>
#include <vector>

#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/network/plan.hpp>
#include <repel/scene/module_kinds.hpp>

namespace repel::scene {

/// One entry of the network.
struct Module : ReadModule {
  std::string name;  ///< unique in the network
  std::string kind;  ///< the word after `module:`
  network::To to;    ///< where it is connected; by default to the next module
  int line = 0;      ///< of the file
};

/// The network of one arm.
struct Network {
  std::vector<Module> modules;                                ///< from the operator to the robot
  network::GainCheck gain_check = network::GainCheck::error;  ///< of the obstacle module
  int line = 0;                                               ///< of the file; 0: it is the default
};

}  // namespace repel::scene
