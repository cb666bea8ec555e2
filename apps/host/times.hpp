/// @file
/// How measured times are told, in reports for people and for programs.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <repel/schedule/deadline.hpp>

#include "machine.hpp"

namespace repel::host {

/// p50, p99, p99_9 and max [us].
[[nodiscard]] nlohmann::ordered_json percentiles(const DurationHistogram& times);

[[nodiscard]] nlohmann::ordered_json to_json(const Machine& machine);

/// Prints p50, p99, p99.9 and the maximum in one line.
void print_times(const char* name, const DurationHistogram& times, std::FILE* out);

/// Prints the machine, in two lines.
void print_machine(const Machine& machine, std::FILE* out);

}  // namespace repel::host
