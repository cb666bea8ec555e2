// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/times.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

#include <repel/host/command_line.hpp>

namespace repel::host {

using nlohmann::ordered_json;

ordered_json percentiles(const DurationHistogram& times) {
  return {{"p50", times.percentile_us(0.5)},
          {"p99", times.percentile_us(0.99)},
          {"p99_9", times.percentile_us(0.999)},
          {"max", times.max_us()}};
}

ordered_json to_json(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"kernel", machine.kernel},
          {"scheduler", machine.scheduler},
          {"compiler", machine.compiler},
          {"instruction_set", machine.instruction_set},
          {"commit", machine.commit}};
}

ordered_json to_json(const DeadlineMonitor& deadline, std::int64_t skipped_ticks) {
  return {{"deadline_misses", deadline.misses()},
          {"skipped_ticks", skipped_ticks},
          {"success_rate_last_100", deadline.success_rate()},
          {"success_rate_lowest", deadline.lowest_success_rate()},
          {"response_us_max", 1e-3 * static_cast<double>(deadline.longest_response().count())},
          {"compute_us", percentiles(deadline.compute())},
          {"wakeup_us", percentiles(deadline.wakeup())}};
}

double per_tick(const RunTotals& totals, std::int64_t sum) {
  return totals.ticks > 0 ? static_cast<double>(sum) / static_cast<double>(totals.ticks) : 0.0;
}

ordered_json status_ticks(const RunTotals& t) {
  ordered_json status = ordered_json::object();
  for (unsigned bit = 0; bit < 32; ++bit) {
    if (t.status_ticks[bit] > 0) status[repel::to_text(1U << bit)] = t.status_ticks[bit];
  }
  return status;
}

ordered_json to_json(const RunTotals& t, int pairs) {
  return {{"pairs", pairs},
          {"pairs_near_per_tick", per_tick(t, t.near)},
          {"pairs_evaluated_per_tick", per_tick(t, t.evaluated)},
          {"support_pairs_per_tick", per_tick(t, t.iterations)},
          {"pairs_stale", t.most_stale},
          {"pairs_stale_per_tick", per_tick(t, t.stale)},
          {"oldest_age_ticks", t.oldest_age},
          {"refresh_energy_j", t.refresh_energy},
          {"nearest_m", t.nearest},
          {"deepest_m", t.deepest},
          {"peak_force_n", t.peak_force},
          {"status_ticks", status_ticks(t)}};
}

ordered_json known(std::int64_t count) {
  return count < 0 ? ordered_json(nullptr) : ordered_json(count);
}

void write(const ordered_json& report, std::ostream& file) {
  file << report.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void write(const ordered_json& report, Output& file) {
  if (!file.wanted()) return;
  write(report, file.stream());
  file.close();
}

void print_pairs(const RunTotals& t, int pairs, std::FILE* out) {
  std::fprintf(out,
               "  pairs                  %d, near %.2f and evaluated %.2f per tick; %.2f skipped\n",
               pairs, per_tick(t, t.near), per_tick(t, t.evaluated), pairs - per_tick(t, t.near));
}

void print_allocations(std::int64_t count, std::FILE* out) {
  std::fprintf(
      out, "  allocations in tick    %s\n",
      count < 0 ? "not counted (another allocator is in place)" : std::to_string(count).c_str());
}

void print_times(const char* name, const DurationHistogram& times, std::FILE* out) {
  if (times.count() == 0) {
    std::fprintf(out, "  %-22s none\n", name);
    return;
  }
  std::fprintf(out, "  %-22s p50 %8.2f   p99 %8.2f   p99.9 %8.2f   max %9.2f µs\n", name,
               times.percentile_us(0.5), times.percentile_us(0.99), times.percentile_us(0.999),
               times.max_us());
}

void print_machine(const Machine& machine, std::FILE* out) {
  std::fprintf(out,
               "  machine                %s, %s\n                         %s\n"
               "                         %s, pairs by %s, commit %s\n",
               machine.cpu.c_str(), machine.kernel.c_str(), machine.scheduler.c_str(),
               machine.compiler.c_str(), machine.instruction_set.c_str(), machine.commit.c_str());
}

}  // namespace repel::host
