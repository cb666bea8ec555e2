// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force laws at the links of the arms, in terms of forces at the tools.
#pragma once

#include <cstdio>

#include <repel/cell/cell.hpp>
#include <repel/host/times.hpp>
#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// Adds to each obstacle of `result` the links it pushed. Adds a warning for each law, given at the
/// part, weaker than the operator. Call after `note_pairs`.
void note_link_laws(const Cell& cell, RunResult& result);

/// Prints a line for each link that this obstacle pushed.
void print_link_laws(const ObstacleResult& obstacle, std::FILE* out);

/// The same as JSON: a list, empty where the obstacle pushed no link.
[[nodiscard]] nlohmann::ordered_json link_laws_to_json(const ObstacleResult& obstacle);

}  // namespace repel::runs
