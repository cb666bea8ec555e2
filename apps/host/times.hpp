/// @file
/// What the reports of programs have in common, for people and for programs.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <repel/loop/record.hpp>
#include <repel/schedule/deadline.hpp>

#include "machine.hpp"

namespace repel::host {

/// p50, p99, p99_9 and max [us].
[[nodiscard]] nlohmann::ordered_json percentiles(const DurationHistogram& times);

[[nodiscard]] nlohmann::ordered_json to_json(const Machine& machine);

/// Misses, success rates, compute and wake-up times.
[[nodiscard]] nlohmann::ordered_json to_json(const DeadlineMonitor& deadline,
                                             std::int64_t skipped_ticks);

/// The status bits that were set, with the ticks in which they were.
[[nodiscard]] nlohmann::ordered_json status_ticks(const RunTotals& totals);

/// What the pairs of a world did. @param pairs how many there are
[[nodiscard]] nlohmann::ordered_json to_json(const RunTotals& totals, int pairs);

/// The mean of a sum over ticks; 0 without any.
[[nodiscard]] double per_tick(const RunTotals& totals, std::int64_t sum);

/// A count that some machines cannot take: null where it is negative.
[[nodiscard]] nlohmann::ordered_json known(std::int64_t count);

/// Writes a report. A byte that is not UTF-8 does not cost it, nor a number that is not finite,
/// which becomes null.
void write(const nlohmann::ordered_json& report, std::ostream& file);

/// Prints how many pairs were near and evaluated, in one line.
void print_pairs(const RunTotals& totals, int pairs, std::FILE* out);

/// Prints what the tick took from the heap, in one line.
void print_allocations(std::int64_t count, std::FILE* out);

/// Prints p50, p99, p99.9 and the maximum in one line; "none" without a sample.
void print_times(const char* name, const DurationHistogram& times, std::FILE* out);

/// Prints the machine, in three lines.
void print_machine(const Machine& machine, std::FILE* out);

}  // namespace repel::host
