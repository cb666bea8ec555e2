/// @file
/// What a run leaves behind: a table for people, JSON for programs.
#pragma once

#include <cstdio>
#include <iosfwd>

#include "run.hpp"

namespace repel::teleop {

/// Prints the table to `out`.
void print_report(const RunResult& result, std::FILE* out);

/// Prints how the replay of a recording compares with it.
void print_replay(const Recording& recording, const RunResult& result, std::FILE* out);

/// Writes the report as JSON.
void write_json(const RunResult& result, std::ostream& out);

}  // namespace repel::teleop
