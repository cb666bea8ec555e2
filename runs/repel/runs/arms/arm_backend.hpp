// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The simulated arms available to a run.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <repel/simulated/contact.hpp>
#include <repel/world/arm.hpp>

namespace repel::runs {

/// The least inertia of a joint of the arm without dynamics [kg m^2] or [kg].
inline constexpr double least_ideal_inertia = 0.1;

/// One kind of simulated arm.
struct ArmBackend {
  const char* name;
  bool has_gravity;  ///< the links of its arms have masses, on which gravity acts
  bool has_contact;  ///< its arms can collide with obstacles physically
  /// Creates an arm that stops after `watchdog` [s] without torques.
  /// @throws SetupError if it is not built in, or cannot simulate the model
  std::unique_ptr<TorqueDrivenArm> (*make)(const ArmModel& model, std::span<const double> start,
                                           double watchdog, std::span<const ContactPart> parts);
};

[[nodiscard]] std::span<const ArmBackend> arm_backends();

/// @throws SetupError that lists the known names
[[nodiscard]] const ArmBackend& arm_backend(const std::string& name);

}  // namespace repel::runs
