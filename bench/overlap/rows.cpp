// SPDX-License-Identifier: BSD-3-Clause
#include "rows.hpp"

#include "markdown.hpp"

namespace repel::bench {

namespace {

constexpr double degrees = 180.0 / M_PI;

std::string line(const Row& row) {
  const Cost cold = row.cold->cost();
  const Cost warm = row.warm->cost();
  const Verdict& v = row.warm->verdict();
  const Conduct& c = row.conduct;
  const bool checked = row.library.is_checked_in_overlap();
  return text("| %s |", row.library.name.c_str()) +
         text(" %.0f | %.0f | %.0f | %.0f |", cold.p50, cold.p99, warm.p50, warm.p99) +
         text(" %.1f %% | %.1f %% |", 100.0 * v.median_share, 100.0 * v.low_share) +
         text(" %.1e | %.1e |", v.median_relative, v.high_relative) +
         text(checked ? " %d of %d |" : " %d of %d missing |", row.wrong(), row.asked()) +
         text(" %.3g | %.3g |", 1e3 * c.median_dead_zone, 1e3 * c.worst_dead_zone) +
         text(" %.2g | %.1f | %.1f |\n", 1e3 * c.excess, degrees * c.median_turn, degrees * c.turn);
}

/// The libraries other than repel, each once.
std::string versions(const Rows& rows) {
  std::string out = "Settings as for distances:";
  for (const Row& row : rows) {
    if (row.library.ours || row.warm->task().name != rows.front().warm->task().name) continue;
    out += " " + row.library.name + " " + row.library.version + ";";
  }
  out.back() = '.';
  return out + "\n";
}

}  // namespace

std::string overlap_table(const Rows& rows) {
  std::string out = versions(rows);
  std::string input;
  for (const Row& row : rows) {
    if (row.warm->task().name != input) {
      input = row.warm->task().name;
      out += "\n## " + input + "\n\n" +
             heading({"setting", "cold p50 [ns]", "cold p99", "warm p50", "warm p99",
                      "share of the depth, median", "95 % have at least", "error, median",
                      "error, p95", "wrong or missing", "dead zone, median [mm]", "worst",
                      "value jump less motion [mm]", "direction jump, median [degrees]", "worst"});
    }
    out += line(row);
  }
  return out;
}

std::string faults(const Rows& rows) {
  std::string out;
  for (const Row& row : rows) {
    if (!row.library.ours) continue;
    const std::string who = row.library.name + ", " + row.warm->task().name + ": ";
    const Conduct& c = row.conduct;
    if (const int wrong = row.wrong() + c.wrong; wrong > 0) {
      out += who + text("%d answers are wrong\n", wrong);
    }
    if (c.jumps()) {
      out +=
          who + text("the value jumps in step %zu of sweep %zu, by %.3g m more than the motion\n",
                     c.steepest.tick, c.steepest.pair, c.excess);
    }
  }
  return out;
}

}  // namespace repel::bench
