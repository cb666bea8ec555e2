/// @file
/// What of the program a run does without.
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace repel::teleop {

/// The parts that were not built or never ran, because neither scene nor options use them.
[[nodiscard]] std::vector<std::string> unused_parts(const RunResult& result);

}  // namespace repel::teleop
