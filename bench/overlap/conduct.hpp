/// @file
/// How the answers of a library behave while one solid moves into and through the other.
#pragma once

#include "measurement.hpp"

namespace repel::bench {

/// What the largest step of the answers is, and how deep an overlap goes unnoticed.
struct Conduct {
  /// [m] The greatest true depth answered by less than a hundredth of it, pair by pair.
  double median_dead_zone = 0.0;
  double worst_dead_zone = 0.0;
  double excess = 0.0;  ///< [m] largest change of the value in a step, less the motion of the step
  Ask steepest;         ///< the step of that change
  double turn = 0.0;    ///< [rad] largest change of the direction in a step
  double median_turn = 0.0;  ///< [rad] of the largest on each way
  /// Of ours: pressed not finite, too deep or outside its bracket; on its way through not finite.
  int wrong = 0;

  /// A distance changes no faster than the solids move; rounding is 1e-15 of them.
  [[nodiscard]] bool jumps() const { return excess > 1e-12; }
};

/// Asks the library along both, warm, step by step.
[[nodiscard]] Conduct conduct_of(const Library& library, const CheckedTask& presses,
                                 const Task& sweeps);

}  // namespace repel::bench
