/// @file
/// What the network of a run did: energy ledgers, warnings, its own cost.
#pragma once

#include <cstdio>

#include "run.hpp"
#include "times.hpp"

namespace repel::teleop {

/// Prints one line for each module of each arm, the cost of the networks and what the gain check
/// had to say.
void print_network(const RunResult& result, std::FILE* out);

/// The modules of one network as JSON.
[[nodiscard]] nlohmann::ordered_json modules_to_json(const std::vector<ModuleResult>& modules);

}  // namespace repel::teleop
