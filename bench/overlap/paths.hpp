/// @file
/// Pairs on their way into and through each other.
#pragma once

#include "task.hpp"

namespace repel::bench {

/// Solids pressed into each other from contact: each step goes a tenth deeper than the one before,
/// from a micrometre to 0.3 m. At every tick every pair overlaps.
[[nodiscard]] Task press_task(int vertices, int count);

/// Solids that pass through each other in 200 steps, from apart to apart: every second pair on a
/// straight line, the others on a screw.
[[nodiscard]] Task sweep_task(int vertices, int count);

/// [m] What the farthest moved vertex of the first solid of the pair moves by in the step to
/// `tick`.
[[nodiscard]] double motion(const Task& task, const Ask& ask);

}  // namespace repel::bench
