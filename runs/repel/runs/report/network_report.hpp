// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reports on the networks of a run: energy ledgers and computing time.
#pragma once

#include <cstdio>

#include <repel/host/times.hpp>
#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// Prints the computing time of the networks, one line for each module of each arm, and one for
/// each source of its stability budget.
void print_network(const RunResult& result, std::FILE* out);

/// The modules of one network as JSON.
[[nodiscard]] nlohmann::ordered_json modules_to_json(const std::vector<ModuleResult>& modules);

/// What each spring and damper takes of the stability of an arm, as JSON.
[[nodiscard]] nlohmann::ordered_json stability_to_json(const ArmResult& arm);

/// Adds what the force sensor of an arm measured to its report; null without one.
void add_measured(const ArmResult& arm, nlohmann::ordered_json& report);

}  // namespace repel::runs
