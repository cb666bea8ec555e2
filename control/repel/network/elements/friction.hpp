// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Compensation of dry friction in the joints of a geared arm.
#pragma once

namespace repel::network {

/// Adds most of the dry friction of a joint to its commanded torque, through a bounded low-pass
/// without wind-up:
///
///     tau = share mu s      time ds/dt = clamp(tau_d / mu, -1, 1) / (1 - share) - s,   |s| <= 1
///
/// with mu the dry friction and tau_d the commanded torque, by the implicit Euler rule with the
/// period T. A joint at rest breaks away at |tau_d| = (1 - share) mu, its remaining friction, and
/// moves steadily with as much. The measured rate does not enter: near standstill it is noise, and
/// a compensation by its sign would chatter.
///
/// Continuous: in a tick tau changes with tau_d by at most share / (1 - share) T / (time + T) times
/// as much, and altogether by at most mu share (2 - share) / (1 - share) T / (time + T).
///
/// Passive: |tau| <= share mu in every state, so that with the friction itself
/// tau v - mu |v| <= -(1 - share) mu |v|. Compensation and friction together dissipate, at any
/// instant and whatever the delay of the drive, as long as the true friction is above share mu.
/// It is reduced, never overcompensated.
///
/// One for each joint, revolute or prismatic. Costs two divisions a tick.
struct FrictionCompensation {
  double share = 0.8;  ///< of the dry friction, 0 or more, below 1
  double time = 0.05;  ///< [s] time constant of the low-pass
  double part = 0.0;   ///< s, the present compensation, -1 to 1

  /// Advances by one period and returns the torque to add [N m] or [N]. `asked` is tau_d. Without
  /// friction, and for an `asked` that is not finite, it is 0 and starts anew.
  [[nodiscard]] double operator()(double dry_friction, double asked, double period) noexcept;
};

}  // namespace repel::network
