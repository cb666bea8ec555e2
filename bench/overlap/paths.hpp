// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Motion sequences of pairs of solids into and through each other.
#pragma once

#include "task.hpp"

namespace repel::bench {

/// Solids pressed into each other from contact: the penetration grows by a tenth at each step, from
/// a micrometre to 0.3 m. Every pair overlaps at every tick.
[[nodiscard]] Task press_task(int vertices, int count);

/// Solids that pass through each other in 200 steps, separated at both ends: every second pair on a
/// straight line, the others on a screw.
[[nodiscard]] Task sweep_task(int vertices, int count);

/// [m] Largest displacement of a vertex of the first solid of the pair in the step to `tick`.
[[nodiscard]] double motion(const Task& task, const Ask& ask);

}  // namespace repel::bench
