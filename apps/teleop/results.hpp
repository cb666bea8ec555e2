/// @file
/// What is left of a run when it is over.
#pragma once

#include <vector>

#include <repel/network/network.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "run.hpp"

namespace repel::teleop {

/// What every obstacle did, and the nearest pair of all. Once `coprocessor` has stopped.
void note_pairs(const World& world, const Coprocessor& coprocessor, RunResult& result);

/// What every module did, in the order of the network.
[[nodiscard]] std::vector<ModuleResult> module_results(const network::Network& network);

}  // namespace repel::teleop
