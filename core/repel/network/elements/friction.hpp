/// @file
/// Compensation of dry friction in the joints of a geared arm.
#pragma once

#include <cmath>

namespace repel::network {

/// Adds most of the dry friction of a joint in the direction of its motion or commanded torque:
///
///     tau = share mu tanh(v / v0 + tau_d / (r mu))
///
/// with mu the dry friction, v the joint rate, tau_d the commanded torque. The share stays below
/// one, so that the remaining friction always dissipates: friction is reduced, never
/// overcompensated.
struct FrictionCompensation {
  double share = 0.8;            ///< of the dry friction, 0 to 1
  double rate = 0.02;            ///< v0 [rad/s] or [m/s], scale of the transition with the rate
  double relative_torque = 0.5;  ///< r, scale of the transition with tau_d, relative to mu

  /// The torque to add [N m] or [N]. `asked` is tau_d.
  [[nodiscard]] double operator()(double dry_friction, double v, double asked) const noexcept {
    if (!(dry_friction > 0.0)) return 0.0;
    return share * dry_friction * std::tanh(v / rate + asked / (relative_torque * dry_friction));
  }
};

}  // namespace repel::network
