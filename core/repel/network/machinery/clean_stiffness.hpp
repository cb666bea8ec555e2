// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The largest stiffness at which a sampled wall is passive.
#pragma once

#include <limits>
#include <string>

#include <repel/base/setup_error.hpp>

namespace repel::network {

/// What is done about a wall that is too stiff.
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
  [[nodiscard]] double limit() const noexcept {
    const double left = device_damping - (wall_damping < 0.0 ? -wall_damping : wall_damping);
    return left > 0.0 ? left / (0.5 * period + delay) : 0.0;
  }

  /// The device damping b [N s/m] that a wall of `stiffness` [N/m] needs.
  [[nodiscard]] double needed_damping(double stiffness) const noexcept {
    return stiffness * (0.5 * period + delay) + (wall_damping < 0.0 ? -wall_damping : wall_damping);
  }
};

/// Empty when a wall of `stiffness` [N/m] is within the limit; else one sentence with all numbers,
/// to four digits.
[[nodiscard]] inline std::string complaint(const CleanStiffness& at, double stiffness) {
  const auto text = [](double value) { return repel::to_text(value, 4); };
  if (stiffness <= at.limit()) return {};
  return "wall stiffness is " + text(stiffness) + " N/m; the clean-stiffness limit is " +
         text(at.limit()) + " N/m for a period of " + text(1e3 * at.period) + " ms, a delay of " +
         text(1e3 * at.delay) + " ms, " + text(at.device_damping) +
         " N s/m of damping in the device and " + text(at.wall_damping) +
         " N s/m in the wall; this wall needs " + to_text_above(at.needed_damping(stiffness), 4) +
         " N s/m in the device";
}

/// Throws SetupError when the wall is too stiff and `check` is `error`; else returns the complaint.
inline std::string checked_gain(GainCheck check, const CleanStiffness& at, double stiffness) {
  std::string text = complaint(at, stiffness);
  if (check == GainCheck::error && !text.empty()) throw SetupError(text);
  return text;
}

}  // namespace repel::network
