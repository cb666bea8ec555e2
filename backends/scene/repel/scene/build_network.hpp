// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From the network that a scene file lists to one that runs.
#pragma once

#include <string_view>

#include <repel/base/setup_error.hpp>
#include <repel/network/network.hpp>
#include <repel/network/plan.hpp>
#include <repel/network/remote/remote_line.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/arm.hpp>

namespace repel::scene {

/// Whether the network has the module that applies the walls to the links of the arm.
[[nodiscard]] bool feels_links(const ArmSetup& setup);

/// The plan of the network of a setup of the scene, for its arm.
/// @throws SetupError naming the file, if the plan lacks a module that the scene requires
[[nodiscard]] network::Plan plan_network(const Scene& scene, const ArmSetup& setup,
                                         const ArmModel& arm);

/// The plan of a network that a text in YAML lists, as scene files do under `network:`, for an arm.
/// @throws SetupError naming the line of the text and what is wrong in it
[[nodiscard]] network::Plan plan_network(std::string_view list, const ArmModel& arm);

/// A network that is cut at its line, for two programs: the half of one side, whose end of the line
/// is a remote one.
struct NetworkHalf {
  bool is_station = false;  ///< the half of the operator; otherwise that of the robot
  /// For that end; must outlive the network
  network::RemoteLink* link = nullptr;
};

/// The half of the network of a setup; of its `line`, which must be the only one and the only way
/// from one side to the other, impedance and buffer apply. @throws SetupError as `plan_network`
[[nodiscard]] network::Plan plan_half(const Scene& scene, const ArmSetup& setup,
                                      const ArmModel& arm, const NetworkHalf& half);

/// The same network, built for a period of 1 / `rate_hz`.
/// @throws SetupError naming the file and the modules, if it cannot be built
[[nodiscard]] network::Network build_network(const Scene& scene, const ArmSetup& setup,
                                             const ArmModel& arm, double rate_hz);

/// Adds to an error about the cell of a scene the file and, if the message names a module of a
/// network or a wall that is too stiff, its line. An error that already names its file is returned
/// unchanged.
[[nodiscard]] SetupError located(const Scene& scene, const SetupError& error);

}  // namespace repel::scene
