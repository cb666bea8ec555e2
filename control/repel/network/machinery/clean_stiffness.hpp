// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The largest stiffness at which a sampled wall is passive.
#pragma once

namespace repel::network {

/// The reaction to a wall that is too stiff.
enum class GainCheck {
  error,    ///< SetupError
  warning,  ///< a text for the report; the passivity controller has to dissipate the excess energy
};

/// Parameters of the clean-stiffness limit.
struct CleanStiffness {
  double period = 0.0025;       ///< T [s]
  double device_damping = 0.0;  ///< b [N s/m] physical viscous damping of the device
  double wall_damping = 0.0;    ///< B [N s/m] of the wall itself
  double delay = 0.0;  ///< t_d [s] from measurement to actuation, beyond the zero-order hold

  /// Largest K [N/m] of a passive wall, whoever holds the device: b > K (T / 2 + t_d) + |B|
  /// (Colgate and Schenkel 1997; the delay adds to the half period of the zero-order hold). 0 when
  /// |B| reaches b.
  [[nodiscard]] double limit() const noexcept;

  /// The device damping b [N s/m] that a wall of `stiffness` [N/m] needs.
  [[nodiscard]] double needed_damping(double stiffness) const noexcept;
};

}  // namespace repel::network
