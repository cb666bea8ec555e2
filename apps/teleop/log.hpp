/// @file
/// The log of a run: every tick as it was.
#pragma once

#include <iosfwd>

#include "run.hpp"

namespace repel::teleop {

/// Writes one line per tick: first what the world did, then each arm, the columns of a partner
/// behind its name and a slash.
void write_csv(const RunResult& result, std::ostream& out);

}  // namespace repel::teleop
