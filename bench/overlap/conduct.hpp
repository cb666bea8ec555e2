// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Continuity of the answers of a library while one solid moves into and through the other.
#pragma once

#include "measurement.hpp"

namespace repel::bench {

/// Largest steps of the answers, and the dead zone: the depth of overlap that goes undetected.
struct Conduct {
  /// [m] Dead zone of a pair: largest true depth for which the answer is below 1 % of it.
  double median_dead_zone = 0.0;
  double worst_dead_zone = 0.0;
  double excess = 0.0;  ///< [m] largest change of the value in a step minus the motion of the step
  Ask steepest;         ///< the step of that change
  double turn = 0.0;    ///< [rad] largest change of the direction in a step
  double median_turn = 0.0;  ///< [rad] median over the paths of the largest change on each
  /// repel only: on presses answers not finite, too deep or outside their bracket; on sweeps not
  /// finite.
  int wrong = 0;

  /// The distance cannot change faster than the solids move; rounding is 1e-15 of their size.
  [[nodiscard]] bool jumps() const { return excess > 1e-12; }
};

/// Queries the library along both motions, with warm start, step by step.
[[nodiscard]] Conduct conduct_of(const Library& library, const CheckedTask& presses,
                                 const Task& sweeps);

}  // namespace repel::bench
