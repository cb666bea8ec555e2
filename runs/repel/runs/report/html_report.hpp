// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The report of a run as an HTML page.
#pragma once

#include <iosfwd>

#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// Writes a self-contained page: key figures, curves of distance, force, energy and pairs over
/// time, percentiles of time, the slowest ticks, tables of obstacles and modules, the machine, the
/// scene. Requires a run with RunOptions::keep_records.
void write_html(const RunResult& result, std::ostream& out);

}  // namespace repel::runs
