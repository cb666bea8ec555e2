// SPDX-License-Identifier: BSD-3-Clause
#include "html_report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <ostream>

#include "chart.hpp"
#include "chatter_report.hpp"
#include "page.hpp"
#include "unused.hpp"

namespace repel::teleop {
namespace {

using namespace host::page;

double us(std::chrono::nanoseconds time) {
  return 1e-3 * static_cast<double>(time.count());
}

std::string count_of(std::int64_t count) {
  return count < 0 ? "not counted" : std::to_string(count);
}

std::string tiles(const RunResult& r) {
  const RunTotals& t = r.totals();
  const DurationHistogram& compute = r.deadline.compute();
  std::string html = "<dl class='tiles'>\n";
  html += tile("compute of the tick, p99", with_unit(compute.percentile_us(0.99), "us"));
  html += tile("longest", with_unit(compute.max_us(), "us"));
  if (!r.options.fast) {
    html += tile("deadline misses",
                 std::to_string(r.deadline.misses()) + " of " + std::to_string(r.deadline.ticks()));
    html += tile("due to end, longest", with_unit(us(r.deadline.longest_response()), "us"));
    html += tile("wake-up lateness, p99", with_unit(r.deadline.wakeup().percentile_us(0.99), "us"));
  }
  html += tile("nearest", r.nearest_pair.empty() ? "none" : with_unit(1e3 * t.nearest, "mm"));
  html += tile("deepest intrusion", with_unit(1e3 * t.deepest, "mm"));
  html += tile("peak virtual force on the tool", with_unit(t.peak_force, "N"));
  html += tile("allocations in the tick", count_of(r.allocations_in_tick));
  html += tile("system calls in the tick", count_of(r.system_calls_in_tick));
  return html + "</dl>\n";
}

/// A chart over all records of the first arm, with a mark at the start of each phase.
host::Chart chart_of(const RunResult& r, const std::string& title, const std::string& unit) {
  const std::vector<TickRecord>& records = r.arms.front().records;
  host::Chart chart{.title = title, .unit = unit, .samples = records.size()};
  if (!records.empty()) chart.duration = records.back().time - records.front().time;
  for (std::size_t i = 1; i < records.size(); ++i) {
    if (records[i].phase != records[i - 1].phase) chart.marks.push_back(records[i].time);
  }
  return chart;
}

std::string charts_of_the_world(const RunResult& r) {
  const std::vector<TickRecord>& k = r.arms.front().records;
  host::Chart distance = chart_of(r, "Least signed distance of the pairs asked", "mm");
  distance.lines = {0.0};
  distance.curves = {{"nearest", [&k](std::size_t i) { return 1e3 * k[i].pairs.nearest; }}};
  host::Chart pairs = chart_of(r, "Pairs in a tick: those that are not near are skipped", "");
  pairs.curves = {
      {"near", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.near); }},
      {"evaluated", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.evaluated); }},
      {"stale", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.stale); }}};
  return to_html(distance) + to_html(pairs);
}

/// The modules that claim to be passive with the largest ledger magnitudes, as many as there are
/// colours, in the order of the network.
std::vector<std::size_t> fullest(const ArmResult& arm) {
  constexpr std::size_t colours = 6;
  std::vector<std::size_t> modules;
  std::vector<float> most(arm.modules.size(), 0.0F);
  for (std::size_t m = 0; m < arm.modules.size(); ++m) {
    if (!arm.modules[m].claims_passive) continue;
    modules.push_back(m);
    for (const TickRecord& k : arm.records) most[m] = std::max(most[m], std::abs(k.energy[m]));
  }
  std::stable_sort(modules.begin(), modules.end(),
                   [&](std::size_t a, std::size_t b) { return most[a] > most[b]; });
  modules.resize(std::min(colours, modules.size()));
  std::sort(modules.begin(), modules.end());
  return modules;
}

std::string charts_of(const RunResult& r, const ArmResult& arm) {
  const std::vector<TickRecord>& k = arm.records;
  const std::string whose = arm.name.empty() ? "" : arm.name + ": ";
  host::Chart force = chart_of(r, whose + "Forces on the tool, and the hardest of a pair", "N");
  force.curves = {
      {"virtual, of the walls", [&k](std::size_t i) { return k[i].virtual_force.force.norm(); }},
      {"of the operator", [&k](std::size_t i) { return k[i].coupling.force.norm(); }},
      {"hardest pair", [&k](std::size_t i) { return k[i].pairs.peak_force; }}};
  host::Chart energy =
      chart_of(r, whose + "Energy ledgers of modules that claim passivity, the fullest", "J");
  for (const std::size_t m : fullest(arm)) {
    energy.curves.push_back(
        {arm.modules[m].name, [&k, m](std::size_t i) { return double{k[i].energy[m]}; }});
  }
  return to_html(force) + to_html(energy);
}

std::string charts_of_time(const RunResult& r) {
  host::Chart times = chart_of(r, "Time of each tick", "us");
  times.curves = {{"compute", [&r](std::size_t i) { return us(r.times[i].compute); }}};
  host::PercentileChart shares{
      .title = "Share of the ticks that took no longer",
      .lines = {{"compute", host::percentile_points(r.deadline.compute())}},
      .deadline_us = 1e6 / r.options.rate_hz};
  if (!r.options.fast) {
    times.curves.push_back({"lateness", [&r](std::size_t i) { return us(r.times[i].late); }});
    shares.lines.push_back({"wake-up lateness", host::percentile_points(r.deadline.wakeup())});
  }
  return to_html(shares) + to_html(times);
}

std::string phase_name(const RunResult& r, std::int32_t phase) {
  const auto i = static_cast<std::size_t>(phase);
  return i < r.scene.script.size() ? r.scene.script[i].name : "script over";
}

/// Links to those ticks in the live view of the recording.
std::string links_to_replay(const RunResult& r, const std::vector<std::size_t>& ticks) {
  if (!r.options.log.ends_with(".mcap")) {
    return "<p class='soft'>With --log FILE.mcap the replay can be opened at each of them.</p>\n";
  }
  std::string html = "<p>While <code>./run --replay ";
  html += escaped(r.options.log) + " --view</code> is running, they are shown at";
  for (const std::size_t i : ticks) {
    const std::string time = to_text(r.arms.front().records[i].time, 6);
    html += " <a href='http://127.0.0.1:8448/#t=";
    html += time;
    html += "'>";
    html += time;
    html += " s</a>";
  }
  return html + "</p>\n";
}

/// Table of the slowest ticks.
std::string slowest(const RunResult& r) {
  const std::vector<TickRecord>& k = r.arms.front().records;
  std::vector<std::size_t> order(k.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto shown_ticks = static_cast<std::ptrdiff_t>(std::min<std::size_t>(8, order.size()));
  std::partial_sort(
      order.begin(), order.begin() + shown_ticks, order.end(),
      [&](std::size_t a, std::size_t b) { return r.times[a].compute > r.times[b].compute; });
  std::vector<std::vector<std::string>> rows{{"phase", "hardest pair", "at [s]", "compute [us]",
                                              "late [us]", "pairs asked", "support pairs"}};
  order.resize(static_cast<std::size_t>(shown_ticks));
  for (const std::size_t i : order) {
    const PairId hardest = k[i].pairs.hardest_pair;
    rows.push_back({phase_name(r, k[i].phase),
                    hardest.valid() ? r.pair_names[static_cast<std::size_t>(hardest.index)] : "-",
                    to_text(k[i].time, 6), to_text(us(r.times[i].compute), 4),
                    r.options.fast ? "-" : to_text(us(r.times[i].late), 4),
                    std::to_string(k[i].pairs.evaluated), std::to_string(k[i].pairs.iterations)});
  }
  return table(rows, 2) + links_to_replay(r, order);
}

std::string obstacle_table(const RunResult& r) {
  std::vector<std::vector<std::string>> rows{{"obstacle", "hardest on", "of", "peak [N]",
                                              "nearest [mm]", "deepest [mm]", "withstood [N]"}};
  for (const ObstacleResult& o : r.obstacles) {
    const PairExtremes& e = o.extremes;
    rows.push_back({o.name, o.part, o.body, number(e.peak_force),
                    std::isfinite(e.nearest) ? number(1e3 * e.nearest) : "never near",
                    number(1e3 * e.deepest), o.is_hard ? number(o.withstood) : "soft"});
  }
  return table(rows, 3);
}

std::string chatter_table(const ArmResult& arm) {
  const std::string whose = arm.name.empty() ? "" : arm.name + ": ";
  std::vector<std::vector<std::string>> rows{
      {whose + "chatter of", "root mean square", "largest jump"}};
  for (const NamedChatter& each : chatter_list(arm)) {
    rows.push_back({each.name, with_unit(each.chatter.rms, each.unit),
                    with_unit(each.chatter.jump, each.unit)});
  }
  return table(rows, 1);
}

std::string module_table(const ArmResult& arm) {
  std::vector<std::vector<std::string>> rows{{"module", "energy [J]", "lowest [J]", "passed [J]",
                                              "supplied [J]", "controller took [J]", "passive"}};
  for (const ModuleResult& m : arm.modules) {
    rows.push_back({m.name, number(m.ledger.energy), number(m.ledger.least),
                    number(m.ledger.passed), number(m.ledger.supplied),
                    number(m.passivity.dissipated),
                    m.passive() ? "yes" : (m.claims_passive ? "NO" : "not claimed")});
  }
  return table(rows, 1);
}

std::string status_table(const RunResult& r) {
  std::vector<std::vector<std::string>> rows{{"status", "arm", "ticks"}};
  for (const ArmResult& arm : r.arms) {
    for (unsigned bit = 0; bit < 32; ++bit) {
      const std::int64_t ticks = arm.totals.status_ticks[bit];
      if (ticks == 0) continue;
      rows.push_back({to_text(Status{1} << bit), arm.name, std::to_string(ticks)});
    }
  }
  return rows.size() > 1 ? table(rows, 2) : "<p>No tick had anything to say.</p>\n";
}

std::string scene_text(const RunResult& r) {
  std::ifstream file(r.scene.file);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return "<details><summary>The scene file</summary><pre>" + escaped(text) + "</pre></details>\n";
}

std::string summary(const RunResult& r) {
  const double seconds = static_cast<double>(r.totals().ticks) / r.options.rate_hz;
  std::string html = "<p class='soft'>";
  html +=
      std::to_string(r.totals().ticks) + " ticks at " + to_text(r.options.rate_hz) + " Hz, " +
      to_text(seconds, 5) + " s; back end " + escaped(r.options.backend) + "; " +
      (r.options.plant_inertia == 1.0
           ? ""
           : "plant inertia " + to_text(r.options.plant_inertia) + "; ") +
      (r.scene.measure == QueryOptions{}.measure
           ? ""
           : "overlaps by " + to_text(r.scene.measure) + "; ") +
      std::to_string(r.pairs) + " pairs; " + std::to_string(r.threads) + " coprocessor threads" +
      (r.threads > 0 ? std::string(" ").append(to_text(r.options.coprocessor)) : std::string()) +
      (r.options.fast ? "; not by the clock" : "") + (r.interrupted ? "; interrupted" : "") +
      "</p>\n";
  return html;
}

}  // namespace

void write_html(const RunResult& r, std::ostream& out) {
  begin(r.scene.name, out);
  out << summary(r);
  if (!r.log_trouble.empty()) {
    out << "<p>The log is not whole: " << escaped(r.log_trouble) << "</p>\n";
  }
  for (const std::string& warning : r.warnings) out << "<p>" << escaped(warning) << "</p>\n";
  out << tiles(r);
  out << "<h2>What was near</h2>\n" << charts_of_the_world(r);
  out << "<h2>What pushed</h2>\n";
  for (const ArmResult& arm : r.arms) out << charts_of(r, arm);
  out << obstacle_table(r) << "<p class='soft'>Chatter: " << about_chatter()
      << "; of the walls that of the worst axis, their torque about the origin of the tool.</p>\n";
  for (const ArmResult& arm : r.arms) out << chatter_table(arm);
  out << "<h2>Time</h2>\n"
      << charts_of_time(r) << "<p class='soft'>The longest ticks:</p>\n"
      << slowest(r) << "<h2>What the ticks said</h2>\n"
      << status_table(r) << "<h2>Energy</h2>\n";
  for (const ArmResult& arm : r.arms) {
    if (!arm.name.empty()) out << "<h3>" << escaped(arm.name) << "</h3>\n";
    out << module_table(arm);
  }
  out << "<h2>Where it ran</h2>\n" << where(r.machine) << "<p>Left out: ";
  const std::vector<std::string> unused = unused_parts(r);
  for (std::size_t i = 0; i < unused.size(); ++i) out << (i > 0 ? ", " : "") << escaped(unused[i]);
  out << ".</p>\n" << scene_text(r);
  end(out);
}

}  // namespace repel::teleop
