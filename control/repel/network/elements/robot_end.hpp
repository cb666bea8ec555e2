// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arm at the end of a network, for automatic gains.
#pragma once

#include <limits>

#include <repel/network/elements/port.hpp>

namespace repel::network {

/// In place of a stiffness or a damping: as stiff as the arm allows.
inline constexpr double automatic = -std::numeric_limits<double>::infinity();

/// The least apparent masses of an arm at the end of its network.
struct RobotEnd {
  double mass = 0.0;        ///< [kg] of the tool, least over directions and poses; 0: not known
  double inertia = 0.0;     ///< [kg m^2] likewise, of its rotation
  Vec<any_size> joints{};   ///< [kg m^2] or [kg] of each joint alone; of size 0: not known
  double speed = 0.25;      ///< [m/s] greatest of the tool
  double response = 0.0;    ///< [s] h, in which the arm follows a change of its torques
  double wall_ticks = 0.5;  ///< B >= wall_ticks T K keeps a wall or a limit stable

  /// The same of an arm of 1 / (1 + g) times the inertia.
  [[nodiscard]] RobotEnd lightened(double g) const;
};

/// A spring and a damper, of a translation or a rotation.
struct Gains {
  double stiffness = 0.0;  ///< [N/m] or [N m/rad]
  double damping = 0.0;    ///< [N s/m] or [N m s/rad]
};

/// Gains with `asked` where it is a number. Where it is `automatic`:
///
///     B = min(m / h, most damping)    K = B^2 / (4 m)
///
/// and at least `usual`. A mass m behind them is critically damped. B = m / h gives the fastest
/// response: a stiffer spring would be faster than the response time h of the arm. Without a known
/// mass: `usual`.
[[nodiscard]] Gains suited(const Gains& asked, double mass, double response, const Gains& usual,
                           double most_damping = std::numeric_limits<double>::infinity()) noexcept;

}  // namespace repel::network
