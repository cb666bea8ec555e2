// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Options, faults and set-up checks of every simulated arm.
#pragma once

#include <span>

#include <repel/simulated/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// How an engine steps, and how stiff the joint stops and physical contacts are.
struct SimulationOptions {
  int substeps = 4;                ///< equal parts of one `step`; 1 to 1000
  double stop_stiffness = 1e5;     ///< [N m/rad] or [N/m] of a joint stop; >= 0
  double stop_damping = 1e3;       ///< [N m s/rad] or [N s/m] while moving into a stop; >= 0
  double contact_stiffness = 1e6;  ///< [N/m] of a contact point; 0 to 1e12
  double contact_damping = 1e4;    ///< [N s/m] of contacts; never pulls; 1e-3 to 1e12
  double contact_friction = 0.5;   ///< friction force as a share of the normal force; 0 to 1e3
  double watchdog = 0.0;  ///< [s] timeout without torques after which the arm stops; 0: never
};

/// Input rejected by a simulated arm since construction or since its faults were cleared.
struct SimulationFaults {
  bool torque = false;  ///< an entry was missing or not usable and was taken as zero
  bool period = false;  ///< a period was not finite or not positive: the arm did not move
  bool state = false;   ///< the motion diverged: the arm was stopped where it was; lower the
                        ///< torques or raise SimulationOptions::substeps
};

/// Throws SetupError naming the joint and the number of `model` beyond every engine: a pose not
/// rigid, an axis not of unit length, a mass, friction or inertia negative or not finite, limits
/// out of order. Set-up only, as all below.
void require_simulable(const ArmModel& model);

/// Throws SetupError naming an option out of its range.
void require_valid(const SimulationOptions& options);

/// Throws SetupError unless `q` [rad] or [m] and `v` [rad/s] or [m/s] (or empty) are finite, one
/// for each link, and `q` within the limits.
void require_state(const ArmModel& model, std::span<const double> q, std::span<const double> v);

}  // namespace repel
