// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How late a position servo is, from a log: the number that an admittance needs.
#pragma once

#include <cstddef>
#include <span>

namespace repel {

/// A position servo as a dead time and a first-order lag behind it.
struct ServoResponse {
  double dead_time = 0.0;  ///< [s]
  double lag = 0.0;        ///< [s] time constant
  double error = 0.0;      ///< [rad] or [m] rms of the measured positions less those of this model
  double moved = 0.0;      ///< [rad] or [m] range of the measured positions

  static constexpr std::size_t fewest = 20;  ///< readings of a log
  static constexpr double longest = 0.5;     ///< [s] of either that is looked for
  static constexpr double explained = 0.05;  ///< share of `moved` that `error` may be

  /// [s] AdmittanceOptions::response, from a commanded rate to the rate of the arm. Both parts
  /// follow a ramp by their length, so that this sum is sure where each of them is not.
  [[nodiscard]] double response() const noexcept { return dead_time + lag; }

  /// The servo is well told by these two numbers, and its motion was longer than its errors.
  [[nodiscard]] bool is_explained() const noexcept {
    return moved > 0.0 && error <= explained * moved;
  }
};

/// Finds the response that explains `measured` by `commanded` with the least squares. A constant
/// difference does not count.
/// @param commanded, measured [rad] or [m] in each period of one joint, both of the same instant
/// @param period [s] between them
/// @return that which is at most `longest` in either part
/// @throws SetupError if there are fewer than `fewest`, not as many of both, or one is not finite
/// Cost: a few thousand passes over the log. Set-up only.
[[nodiscard]] ServoResponse find_response(std::span<const double> commanded,
                                          std::span<const double> measured, double period);

}  // namespace repel
