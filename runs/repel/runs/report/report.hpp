// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The report of a run, as text and as JSON.
#pragma once

#include <cstdio>
#include <iosfwd>

#include <repel/runs/records/recording.hpp>
#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// Prints the report as text.
void print_report(const RunResult& result, std::FILE* out);

/// Prints how a replay compares with its recording.
void print_replay(const Recording& recording, const RunResult& result, std::FILE* out);

/// Writes the report as JSON.
void write_json(const RunResult& result, std::ostream& out);

}  // namespace repel::runs
