/// @file
/// From the network that a scene file lists to one that runs.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/network/network.hpp>
#include <repel/network/plan.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/arm.hpp>

namespace repel::scene {

/// Whether the network has the module that applies the walls to the links of the arm.
[[nodiscard]] bool feels_links(const ArmSetup& setup);

/// The plan of the network of a setup of the scene, for its arm.
/// @throws SetupError naming the file, if the plan lacks a module that the scene requires
[[nodiscard]] network::Plan plan_network(const Scene& scene, const ArmSetup& setup,
                                         const ArmModel& arm);

/// The same network, built for a period of 1 / `rate_hz`.
/// @throws SetupError naming the file and the modules, if it cannot be built
[[nodiscard]] network::Network build_network(const Scene& scene, const ArmSetup& setup,
                                             const ArmModel& arm, double rate_hz);

/// Adds to an error about the cell of a scene the file and, if the message names a module of a
/// network, its line. An error that already names its file is returned unchanged.
[[nodiscard]] SetupError located(const Scene& scene, const SetupError& error);

}  // namespace repel::scene
