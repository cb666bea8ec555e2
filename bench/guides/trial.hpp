// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A task on the simulated PUMA 560, with the simulated operator and fixtures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <repel/network/elements/fixture_path.hpp>

#include "hand.hpp"

namespace repel::guides {

enum class Task {
  seam,  ///< along a spline, close to it
  peg,   ///< from 40 mm above into a hole, close to its axis
};

/// What came of one run.
struct Outcome {
  bool is_done = false;      ///< within the time
  double time = 0.0;         ///< [s] of the task
  double error = 0.0;        ///< [m] root mean square across its way
  double worst = 0.0;        ///< [m] largest
  double guide_force = 0.0;  ///< [N] largest of the fixtures
  double wall_force = 0.0;   ///< [N] largest of the walls on the tool
  std::string complaint{};   ///< a fault, or a ledger below zero; empty: none
};

/// Longest time of a task [s].
inline constexpr double patience = 60.0;

/// Runs the task once. @param fixtures YAML of the list of a module `guide`; empty: none
/// @param seed of the hand, and of where it begins
[[nodiscard]] Outcome run(Task task, const std::string& fixtures, const HandOptions& hand,
                          std::uint64_t seed);

/// The points of the seam, as YAML.
[[nodiscard]] std::string seam_points();

}  // namespace repel::guides
