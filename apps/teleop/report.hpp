/// @file
/// What a run leaves behind: a table for people, JSON for programs, CSV tick by tick.
#pragma once

#include <cstdio>
#include <string>

#include "run.hpp"

namespace repel::teleop {

/// Prints the table to `out`.
void print_report(const RunResult& result, std::FILE* out);

/// Writes the report as JSON. Throws SetupError when `path` cannot be written.
void write_json(const RunResult& result, const std::string& path);

/// Writes one line per tick. Throws SetupError when `path` cannot be written.
void write_csv(const RunResult& result, const std::string& path);

}  // namespace repel::teleop
