// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What opposes a joint besides inertia and dry friction: viscous friction and stops.
#pragma once

#include <algorithm>

#include <repel/simulated/simulated_arm.hpp>

namespace repel {

/// A damper C and a spring K at a joint over a sub-step of h seconds. With v' the next speed and
/// `beyond` the predicted penetration of a stop, they push with -C v' - K (beyond + h (v' - v)).
struct JointResistance {
  double damping = 0.0;    ///< [N m s/rad] or [N s/m]
  double stiffness = 0.0;  ///< [N m/rad] or [N/m]; 0 away from the stops
  double beyond = 0.0;     ///< [rad] or [m] of the stop, at constant speed; 0 away from the stops

  /// What the implicit part of a sub-step of `h` [s] adds to the inertia of the joint [kg m^2] or
  /// [kg].
  [[nodiscard]] double inertia(double h) const noexcept { return h * damping + h * h * stiffness; }
};

/// The resistance of the joint of `link` at position `q` and speed `v` over a sub-step of `h` [s].
[[nodiscard]] inline JointResistance resistance_of(const ArmLink& link,
                                                   const SimulationOptions& options, double q,
                                                   double v, double h) noexcept {
  const double next = q + h * v;
  const double beyond = next - std::clamp(next, link.lower, link.upper);
  // A stop damps inward motion only; on the way out a damper would hold the joint back.
  return {link.viscous_friction + (beyond * v > 0.0 ? options.stop_damping : 0.0),
          beyond == 0.0 ? 0.0 : options.stop_stiffness, beyond};
}

}  // namespace repel
