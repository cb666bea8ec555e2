// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Shared parts of the reports, as text and JSON.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <repel/common/deadline.hpp>
#include <repel/host/machine.hpp>
#include <repel/loop/record.hpp>

namespace repel::host {

class Output;

/// p50, p99, p99_9 and max [us].
[[nodiscard]] nlohmann::ordered_json percentiles(const DurationHistogram& times);

[[nodiscard]] nlohmann::ordered_json to_json(const Machine& machine);

/// Misses, success rates, compute and wake-up times.
[[nodiscard]] nlohmann::ordered_json to_json(const DeadlineMonitor& deadline,
                                             std::int64_t skipped_ticks);

/// For each status bit: the number of ticks with it; only bits that were set.
[[nodiscard]] nlohmann::ordered_json status_ticks(const RunTotals& totals);

/// Statistics of the pairs of a world.
///
/// @param pairs how many there are
[[nodiscard]] nlohmann::ordered_json to_json(const RunTotals& totals, int pairs);

/// `sum` divided by the number of ticks; 0 without ticks.
[[nodiscard]] double per_tick(const RunTotals& totals, std::int64_t sum);

/// A count that is not available on some machines: null if negative.
[[nodiscard]] nlohmann::ordered_json known(std::int64_t count);

/// Writes a report. Bytes other than UTF-8 are replaced; numbers not finite become null.
void write(const nlohmann::ordered_json& report, std::ostream& file);
/// The same to a file of its own, if it is wanted, which is closed. @throws SetupError as it does
void write(const nlohmann::ordered_json& report, Output& file);

/// Prints how many pairs were near and evaluated, in one line.
void print_pairs(const RunTotals& totals, int pairs, std::FILE* out);

/// Prints the number of heap allocations in the tick, in one line.
void print_allocations(std::int64_t count, std::FILE* out);

/// Prints p50, p99, p99.9 and the maximum in one line; "none" without a sample.
void print_times(const char* name, const DurationHistogram& times, std::FILE* out);

/// Prints the machine, in three lines.
void print_machine(const Machine& machine, std::FILE* out);

}  // namespace repel::host
