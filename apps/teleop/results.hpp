/// @file
/// Collects results at the end of a run.
#pragma once

#include <vector>

#include <repel/network/network.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "run.hpp"

namespace repel::teleop {

/// Collects the extremes of every obstacle, of the walls and of the passable bodies, and the
/// nearest pair of all. Call once `coprocessor` has stopped.
void note_pairs(const World& world, const Coprocessor& coprocessor, RunResult& result);

/// The results of every module, in the order of the network.
[[nodiscard]] std::vector<ModuleResult> module_results(const network::Network& network);

}  // namespace repel::teleop
