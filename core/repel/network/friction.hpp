/// @file
/// Compensation of dry friction in the joints of a geared arm.
#pragma once

#include <cmath>

namespace repel::network {

/// Adds most of the dry friction of a joint in the direction it moves or is asked to move:
///
///     tau = share mu tanh(v / v0 + tau_d / (r mu))
///
/// with mu the dry friction, v the joint rate, tau_d the torque asked of it. The share stays below
/// one, so that what is left always brakes: friction is reduced, never turned into drive.
struct FrictionCompensation {
  double share = 0.8;            ///< of the dry friction, 0 to 1
  double rate = 0.02;            ///< v0 [rad/s] or [m/s] at which it is mostly there
  double relative_torque = 0.5;  ///< r, torque asked for relative to mu at which it is mostly there

  /// The torque to add [N m] or [N].
  [[nodiscard]] double operator()(double dry_friction, double v, double asked) const noexcept {
    if (!(dry_friction > 0.0)) return 0.0;
    return share * dry_friction * std::tanh(v / rate + asked / (relative_torque * dry_friction));
  }
};

}  // namespace repel::network
