// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/html_report.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <ostream>
#include <utility>

#include <repel/host/page/chart.hpp>
#include <repel/host/page/page.hpp>
#include <repel/runs/report/chatter_report.hpp>
#include <repel/runs/report/html_words.hpp>
#include <repel/runs/report/unused.hpp>

namespace repel::runs {
namespace {

using namespace host::page;

double us(std::chrono::nanoseconds time) {
  return 1e-3 * static_cast<double>(time.count());
}

std::string count_of(std::int64_t count) {
  return count < 0 ? "not counted" : std::to_string(count);
}

/// One of html_words with its value.
std::string word_tile(const char* word, const std::string& value) {
  return tile(word, value, meaning_of(word));
}

std::string word_table(const std::vector<std::vector<std::string>>& rows, std::size_t names) {
  return table(rows, names, &meaning_of);
}

std::string nearest_text(double nearest) {
  return std::isfinite(nearest) ? with_unit(1e3 * nearest, "mm") : "none";
}

std::string tiles(const RunResult& r) {
  const RunTotals& t = r.totals();
  const DurationHistogram& compute = r.deadline.compute();
  std::string html = "<dl class='tiles'>\n";
  html += word_tile("compute time, p99", with_unit(compute.percentile_us(0.99), "µs"));
  html += word_tile("compute time, longest", with_unit(compute.max_us(), "µs"));
  if (!r.options.fast) {
    html += word_tile("deadline misses", std::to_string(r.deadline.misses()) + " of " +
                                             std::to_string(r.deadline.ticks()));
    html += word_tile("response time, longest", with_unit(us(r.deadline.longest_response()), "µs"));
    html += word_tile("lateness, p99", with_unit(r.deadline.wakeup().percentile_us(0.99), "µs"));
  }
  html += word_tile("nearest of all pairs", nearest_text(t.nearest));
  html += word_tile("nearest of walls", nearest_text(r.walls.nearest));
  html += word_tile("deepest of all pairs", with_unit(1e3 * t.deepest, "mm"));
  html += word_tile("deepest in a wall", with_unit(1e3 * r.walls.deepest, "mm"));
  html += word_tile("largest virtual force", with_unit(t.peak_force, "N"));
  html += word_tile("allocations in a tick", count_of(r.allocations_in_tick));
  html += word_tile("system calls in a tick", count_of(r.system_calls_in_tick));
  return html + "</dl>\n";
}

/// The words that the page has, with what they mean.
std::string legend_of_words(const std::string& page) {
  std::string html =
      "<details><summary>What the words mean</summary>\n<p class='soft'>The same is shown where "
      "the pointer rests on a word with dots below it.</p>\n<dl class='words'>\n";
  for (const Word& each : html_words) {
    const std::string word = escaped(std::string(each.word));
    const bool is_used = page.find(">" + word + "<") != std::string::npos ||
                         page.find("\"" + word + "\"") != std::string::npos;  // of a curve
    if (!is_used) continue;
    html += "<dt>" + escaped(std::string(each.word)) + "</dt><dd>" +
            escaped(std::string(each.meaning)) + "</dd>\n";
  }
  return html + "</dl></details>\n";
}

/// The curves with what their names mean.
std::string explained(host::Chart chart) {
  for (host::Curve& curve : chart.curves) curve.meaning = meaning_of(curve.name);
  return to_html(chart);
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
  host::Chart distance = chart_of(r, "Least signed distance of all pairs at a tick", "mm");
  distance.lines = {0.0};
  distance.even_to = 20.0;  // where forces begin, as a rule
  distance.curves = {
      {"nearest of all pairs", [&k](std::size_t i) { return 1e3 * k[i].pairs.nearest; }}};
  host::Chart pairs = chart_of(
      r, "Pairs at a tick: those that are not near are skipped, stale answers are old", "");
  pairs.curves = {
      {"near", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.near); }},
      {"evaluated", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.evaluated); }},
      {"stale", [&k](std::size_t i) { return static_cast<double>(k[i].pairs.stale); }}};
  return explained(std::move(distance)) + explained(std::move(pairs));
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
  host::Chart force = chart_of(r, whose + "Forces on the tool, and the largest of one pair", "N");
  force.curves = {{"virtual force, of all pairs",
                   [&k](std::size_t i) { return k[i].virtual_force.force.norm(); }},
                  {"coupling force, of the operator",
                   [&k](std::size_t i) { return k[i].coupling.force.norm(); }},
                  {"largest of a pair", [&k](std::size_t i) { return k[i].pairs.peak_force; }}};
  if (std::any_of(k.begin(), k.end(), [](const TickRecord& each) { return each.held_force > 0; })) {
    force.curves.push_back(
        {"by which hard walls held", [&k](std::size_t i) { return k[i].held_force; }});
  }
  host::Chart energy =
      chart_of(r, whose + "Energy ledgers of modules that claim passivity, the fullest", "J");
  for (const std::size_t m : fullest(arm)) {
    energy.curves.push_back(
        {arm.modules[m].name, [&k, m](std::size_t i) { return double{k[i].energy[m]}; }});
  }
  return explained(std::move(force)) + explained(std::move(energy));
}

std::string charts_of_time(const RunResult& r) {
  host::Chart times = chart_of(r, "Compute time and lateness of each tick", "µs");
  times.curves = {{"compute time", [&r](std::size_t i) { return us(r.times[i].compute); }}};
  host::PercentileChart shares{
      .title = "Share of the ticks that took no longer",
      .lines = {{"compute time", host::percentile_points(r.deadline.compute())}},
      .deadline_us = 1e6 / r.options.rate_hz};
  if (!r.options.fast) {
    times.curves.push_back({"lateness", [&r](std::size_t i) { return us(r.times[i].late); }});
    shares.lines.push_back({"lateness", host::percentile_points(r.deadline.wakeup())});
  }
  return to_html(shares) + explained(std::move(times));
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
  std::string html = "<p>While <code>./run replay ";
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
  std::vector<std::vector<std::string>> rows{{"phase", "pair of the largest force", "at [s]",
                                              "compute [µs]", "late [µs]", "evaluated pairs",
                                              "support steps"}};
  order.resize(static_cast<std::size_t>(shown_ticks));
  for (const std::size_t i : order) {
    const PairId hardest = k[i].pairs.hardest_pair;
    rows.push_back({phase_name(r, k[i].phase),
                    hardest.valid() ? r.pair_names[static_cast<std::size_t>(hardest.index)] : "-",
                    to_text(k[i].time, 6), to_text(us(r.times[i].compute), 4),
                    r.options.fast ? "-" : to_text(us(r.times[i].late), 4),
                    std::to_string(k[i].pairs.evaluated), std::to_string(k[i].pairs.iterations)});
  }
  return word_table(rows, 2) + links_to_replay(r, order);
}

std::string obstacle_table(const RunResult& r) {
  std::vector<std::vector<std::string>> rows{{"obstacle", "largest on", "body of it",
                                              "largest of a pair [N]", "nearest [mm]",
                                              "deepest [mm]", "hard wall held [N]"}};
  for (const ObstacleResult& o : r.obstacles) {
    const PairExtremes& e = o.extremes;
    rows.push_back({o.name, o.part, o.body, number(e.peak_force),
                    std::isfinite(e.nearest) ? number(1e3 * e.nearest) : "never near",
                    number(1e3 * e.deepest), o.is_hard ? number(o.withstood) : "soft"});
  }
  return word_table(rows, 3);
}

std::string chatter_table(const ArmResult& arm) {
  const std::string whose = arm.name.empty() ? "" : arm.name + ": ";
  std::vector<std::vector<std::string>> rows{{"chatter of", "root mean square", "largest jump"}};
  for (const NamedChatter& each : chatter_list(arm)) {
    rows.push_back({whose + each.name, with_unit(each.chatter.rms, each.unit),
                    with_unit(each.chatter.jump, each.unit)});
  }
  return word_table(rows, 1);
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
  return word_table(rows, 1);
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
  return rows.size() > 1 ? word_table(rows, 2) : "<p>No tick had anything to say.</p>\n";
}

/// What is otherwise than in the scene file, and the faults that were injected.
std::string changes_and_faults(const RunResult& r) {
  std::string html;
  for (const scene::Change& each : r.scene.changes) {
    html += "<p>Changed in the scene: " + escaped(each.path + ": " + each.value) + "</p>\n";
  }
  for (const faults::Choice& each : r.options.faults) {
    html += "<p>Injected fault: " + escaped(each.name) + ", from " + to_text(each.begin) +
            " s on</p>\n";
  }
  return html;
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
  std::string page = summary(r);
  if (!r.log_trouble.empty()) {
    page += "<p>The log is not whole: " + escaped(r.log_trouble) + "</p>\n";
  }
  page += changes_and_faults(r);
  for (const std::string& warning : r.warnings) page += "<p>" + escaped(warning) + "</p>\n";
  page += tiles(r);
  page +=
      "<p class='soft'>At the pointer, all charts of time show the values of the same moment; drag "
      "to zoom in, double click to see all.</p>\n";
  page += "<h2>What was near</h2>\n" + charts_of_the_world(r);
  page += "<h2>What pushed</h2>\n";
  for (const ArmResult& arm : r.arms) page += charts_of(r, arm);
  page += obstacle_table(r) + "<p class='soft'>Chatter: " + about_chatter() +
          "; of the walls that of the worst axis, their torque about the origin of the tool.</p>\n";
  for (const ArmResult& arm : r.arms) page += chatter_table(arm);
  page += "<h2>Time</h2>\n" + charts_of_time(r) +
          "<p class='soft'>The ticks with the longest compute time:</p>\n" + slowest(r) +
          "<h2>What the ticks said</h2>\n" + status_table(r) + "<h2>Energy</h2>\n";
  for (const ArmResult& arm : r.arms) {
    if (!arm.name.empty()) page += "<h3>" + escaped(arm.name) + "</h3>\n";
    page += module_table(arm);
  }
  page += "<h2>Where it ran</h2>\n" + where(r.machine) + "<p>Left out: ";
  const std::vector<std::string> unused = unused_parts(r);
  for (std::size_t i = 0; i < unused.size(); ++i) page += (i > 0 ? ", " : "") + escaped(unused[i]);
  page += ".</p>\n";
  out << page << legend_of_words(page) << scene_text(r);
  end(out);
}

}  // namespace repel::runs
