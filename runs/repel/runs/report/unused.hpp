// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Lists the parts of the program that a run does not use.
#pragma once

#include <string>
#include <vector>

#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// The parts that were not built or never ran, because neither the scene nor the options use them.
[[nodiscard]] std::vector<std::string> unused_parts(const RunResult& result);

}  // namespace repel::runs
