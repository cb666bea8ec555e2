/// @file
/// The report of a run as a page for people.
#pragma once

#include <iosfwd>

#include "run.hpp"

namespace repel::teleop {

/// Writes one page that needs nothing beside itself: what the run came to, curves of distance,
/// force, energy and pairs over time, percentiles of time, the slowest ticks, what every obstacle
/// and module did, the machine, the scene. Of a run that kept its records.
void write_html(const RunResult& result, std::ostream& out);

}  // namespace repel::teleop
