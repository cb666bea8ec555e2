// SPDX-License-Identifier: BSD-3-Clause
#include "trials_page.hpp"

#include <repel/host/page/chart.hpp>
#include <repel/host/page/page.hpp>

using namespace repel;
using namespace repel::host::page;

namespace {

std::vector<std::string> row_of(const host::Trial& t) {
  const auto us = [](double time) { return to_text(time, 4); };
  const DurationHistogram& compute = t.deadline.compute();
  const DurationHistogram& late = t.deadline.wakeup();
  return {to_text(t.options.rate_hz),
          std::to_string(t.deadline.ticks()),
          std::to_string(t.deadline.misses()),
          us(compute.percentile_us(0.5)),
          us(compute.percentile_us(0.99)),
          us(compute.max_us()),
          us(late.percentile_us(0.5)),
          us(late.percentile_us(0.99)),
          us(late.max_us()),
          t.hiccups ? std::to_string(t.hiccups->ticks()) : "-"};
}

host::PercentileChart chart_of(const host::Trial& t) {
  std::string title = to_text(t.options.rate_hz);
  title += " Hz: share of the ticks that took, or were late, no longer";
  return {.title = title,
          .lines = {{"compute", host::percentile_points(t.deadline.compute())},
                    {"wake-up lateness", host::percentile_points(t.deadline.wakeup())}},
          .deadline_us = 1e6 / t.options.rate_hz};
}

}  // namespace

void write_page(const std::vector<host::Trial>& trials, std::ostream& out) {
  begin("How ticks meet their deadlines", out);
  std::vector<std::vector<std::string>> rows{{"rate [Hz]", "ticks", "misses", "compute p50 [us]",
                                              "p99", "max", "late p50 [us]", "p99", "max",
                                              "ticks with a hiccup"}};
  for (const host::Trial& trial : trials) rows.push_back(row_of(trial));
  out << table(rows, 0)
      << "<p class='soft'>A hiccup is more than 10 µs between two readings of the clock in another "
         "thread.</p>\n";
  for (const host::Trial& trial : trials) out << to_html(chart_of(trial));
  out << "<h2>Where it ran</h2>\n" << where(host::describe_machine(host::granted(trials.front())));
  end(out);
}
