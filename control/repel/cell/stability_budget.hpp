// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The share of each spring and damper of a cell in the stability limit of its sampled loop.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <repel/cell/cell.hpp>

namespace repel {

/// One source of force on an arm, in the direction in which the arm is lightest. A spring and a
/// damper of their own ring in a sampled loop from
///
///     K T^2 / M = 4        B T / M = 2
///
/// on. The damping of walls, limits and couplings is solved together with the mass, so only
/// `needed_damping` limits them (docs/network.md).
struct StabilityShare {
  std::string source;           ///< such as "walls, turning"
  double spring = 0.0;          ///< K T^2 / M
  double damper = 0.0;          ///< B T / M
  double needed_damping = 0.0;  ///< (0.5 + 2 d) K T / B: up to 1 it is stable behind a drive late
                                ///< by d ticks; 0 where damping is added while it acts
};

/// The stability budget of an arm at its start: the stiffest wall of its tool, the turning of
/// contact patches (F a / e, of half width a, force F and tilt e), coupling, fixtures, and the
/// limits of each joint. Not for the tick.
/// @param cell at its start @param arm its place in the description
[[nodiscard]] std::vector<StabilityShare> stability_budget(const Cell& cell, std::size_t arm);

}  // namespace repel
