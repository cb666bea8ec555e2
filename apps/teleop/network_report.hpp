/// @file
/// What the network of a run did: energy ledgers, warnings, its own cost.
#pragma once

#include <cstdio>

#include "run.hpp"
#include "times.hpp"

namespace repel::teleop {

/// Prints one line for each module, the cost of the network and what the gain check had to say.
void print_network(const RunResult& result, std::FILE* out);

/// The same as JSON: `network_us`, `device_damping_n_s_per_m`, `warnings`, `modules`.
[[nodiscard]] nlohmann::ordered_json network_to_json(const RunResult& result);

}  // namespace repel::teleop
