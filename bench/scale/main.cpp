// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Cost of a tick of the world from 32 to 1 000 000 pairs, with its results checked against brute
/// force.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "../distance/program.hpp"
#include "crowding.hpp"
#include "report.hpp"

namespace repel::scale {

namespace {

using bench::Arguments;
using bench::is_chosen;

constexpr const char* about =
    "scale: what a tick of the world costs from 32 to 1 000 000 pairs: World::place of what moves\n"
    "and Coprocessor::exchange. A tool of convex parts moves among obstacles as a hand moves it.\n"
    "\n"
    "  --pairs N     this many pairs, 1 to 1 000 000, ours alone; default: the sweep, 32 to\n"
    "                1 000 000 pairs, beside every pair evaluated and the broad phases of other\n"
    "                libraries, and the 4 x 8 scene beside their warm queries\n"
    "  --near K      with --pairs: pairs within range, mean of the ticks, 1 to 5000; default 3\n"
    "  --ticks T     default 10 000; in the sweep 2000\n"
    "  --threads N   with --pairs: 0 to 16, 0 in the caller; default 0; the sweep has 0, 1 and 2\n"
    "                together and 1 beside; threads without a processor are not started\n"
    "  --mode M      with --threads: together (default): the caller and the threads share the "
    "pairs\n"
    "                of a tick; beside: the caller uses the threads' answer of the last tick\n"
    "  --speed V     of the tool in mm/s, root mean square; default 280\n"
    "  --bodies N    that move, the tool and bodies with obstacles; default 2\n"
    "  --seed S      default 1\n"
    "  --rival A,B   in the sweep, only these libraries beside ours\n"
    "  --quick       a small sweep: a look, not a result\n"
    "  --json FILE   writes the results as JSON\n"
    "  --help        this text\n"
    "\n"
    "All ticks are timed first and checked after, over the same motion. At every tick the spheres\n"
    "around both parts of every pair are compared one by one, the pairs whose spheres are within\n"
    "range are asked, and their forces must be ours on every body to 1e-8; beside, no pair within\n"
    "range may be missing. A rival must find the same pairs within range or, with forces, give "
    "the\n"
    "same forces. In the first ticks, as many as 300 million\n"
    "evaluations allow (20 million in the sweep), ours must also be equal to itself with\n"
    "CoprocessorOptions::every_pair; JSON says how many (every_pair_ticks).\n"
    "Exit code 1 when an answer of ours is wrong, 2 for what is asked wrongly.\n";

struct Options {
  Setting setting;
  bool sweep = true;
  bool quick = false;
  std::vector<std::string> rivals;
  std::string json;
};

/// Throws std::logic_error for an unknown name.
Options parse(Arguments arguments) {
  Options options;
  Setting& setting = options.setting;
  options.quick = arguments.has("--quick");
  setting.pairs = static_cast<int>(arguments.number("--pairs", 0L, 0L, 1000000L));
  options.sweep = setting.pairs == 0;
  const long ticks = !options.sweep ? 10000 : options.quick ? 50 : 2000;
  setting.ticks = static_cast<int>(arguments.number("--ticks", ticks, 1L, 10000000L));
  if (!options.sweep) {
    setting.near = static_cast<double>(arguments.number("--near", 3L, 1L, 5000L));
    setting.threads = static_cast<int>(arguments.number("--threads", 0L, 0L, 16L));
    const auto mode = coprocessor_mode_named(arguments.value("--mode", "together"));
    if (!mode) throw std::invalid_argument("--mode takes together or beside");
    setting.mode = *mode;
    setting.most_threads = std::max(1, setting.threads);
  }
  setting.speed = 1e-3 * static_cast<double>(arguments.number("--speed", 280L, 1L, 10000L));
  setting.bodies = static_cast<int>(arguments.number("--bodies", 2L, 1L, 60L));
  setting.seed = static_cast<std::uint64_t>(arguments.number("--seed", 1L, 0L, 1L << 62));
  options.rivals = bench::split(arguments.value("--rival", ""));
  options.json = arguments.value("--json", "");
  arguments.end();
  return options;
}

Scenario measure_all(const Setting& setting, const std::vector<Way>& ways, double evaluations) {
  const Scene scene = crowded_scene(setting);
  Scenario scenario{.setting = setting, .tool_parts = scene.tool_parts(), .speed = scene.speed()};
  for (const Part& part : scene.parts()) {
    scenario.shape_bytes += static_cast<double>(part.shape.bytes());
  }
  const Record* every_pair = nullptr;
  for (const Way& way : ways) {
    std::fprintf(stderr, "%d pairs, %.0f near: %s, %d threads\n", setting.pairs, setting.near,
                 way.name.c_str(), way.threads);
    const double affordable = std::max(10.0, evaluations / setting.pairs);
    const int ticks =
        way.every_pair && affordable < setting.ticks ? static_cast<int>(affordable) : setting.ticks;
    scenario.runs.push_back(measure(way, scene, ticks));
  }
  // Ours, with and without threads, once more and from the last to the first: what the host does
  // meanwhile then falls on all of them.
  for (std::size_t i = ways.size(); i-- > 0;) {
    if (ways[i].ours && !ways[i].every_pair && ways.size() > 2) {
      scenario.runs[i].add_times(measure(ways[i], scene, setting.ticks));
    }
  }
  const Truth truth = truth_of(scene, setting.ticks);
  scenario.near = truth.near();
  if (scenario.near < 0.9 * setting.near) {
    std::fprintf(stderr, "as close as these parts go: %.3g pairs near, not %.0f\n", scenario.near,
                 setting.near);
  }
  scenario.overlapping =
      static_cast<double>(truth.overlapping) / static_cast<double>(setting.ticks);
  scenario.asked = truth.asked;
  const auto bodies = static_cast<std::size_t>(setting.bodies) + 1;
  for (const Run& run : scenario.runs) {
    // Serves as the reference only if it really evaluated every pair.
    if (run.way.every_pair && run.evaluated == setting.pairs) every_pair = &run.record;
  }
  for (Run& run : scenario.runs) {
    run.check = compare(run.record, truth.record, bodies, run.way.is_beside());
    if (run.way.ours && every_pair != nullptr) {
      if (!run.way.is_beside()) run.every_pair = compare(run.record, *every_pair, bodies);
    }
  }
  for (Run& run : scenario.runs) run.record = {};
  return scenario;
}

std::vector<Scenario> sweep(const Options& options) {
  std::vector<Way> ways{ours(0),      ours(1),      ours(2), ours(1, CoprocessorMode::beside),
                        every_pair(), known_pairs()};
  for (const Way& rival : rivals()) {
    if (is_chosen(options.rivals, rival.library())) ways.push_back(rival);
  }
  std::vector<Scenario> scenarios;
  for (const int pairs : {32, 100, 1000, 10000, 100000, 1000000}) {
    for (const int near : {1, 3, 10, 100}) {
      const bool crowded = 3 * near > pairs;
      const bool skipped = options.quick && (pairs > 1000 || near != 3);
      if (crowded || skipped) continue;
      Setting setting = options.setting;
      setting.pairs = pairs;
      setting.near = near;
      scenarios.push_back(measure_all(setting, ways, 2e7));
    }
  }
  return scenarios;
}

bool is_right(const std::vector<Scenario>& scenarios) {
  bool right = true;
  for (const Scenario& scenario : scenarios) {
    for (const Run& run : scenario.runs) {
      right = right && (!run.way.ours || (run.check.equal() && run.every_pair.equal()));
    }
  }
  return right;
}

void write(const std::string& path, const std::string& words) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << words;
  if (!file.flush()) throw std::invalid_argument("cannot write " + path);
}

int run(const Options& options) {
  std::vector<Scenario> scenarios;
  std::vector<SmallRun> small;
  if (options.sweep) {
    small = small_runs(options.quick ? 2 : 100, options.rivals);
    scenarios = sweep(options);
    write(options.json, to_json(scenarios, small));
  } else {
    scenarios.push_back(measure_all(
        options.setting, {ours(options.setting.threads, options.setting.mode), every_pair()}, 3e8));
    write(options.json, to_json(scenarios.front(), scenarios.front().runs.front()));
  }
  std::printf("%s\n\n%s", bench::build_line().c_str(), to_markdown(scenarios, small).c_str());
  if (options.sweep) std::printf("\n%s", REPEL_ABSENT_RIVALS);
  const bool right =
      is_right(scenarios) && (small.empty() || (small[0].wrong == 0 && small[1].wrong == 0));
  if (!right) std::fprintf(stderr, "ours is not equal to brute force\n");
  return right ? 0 : 1;
}

int start(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  Arguments arguments(words);
  if (arguments.has("--help")) return std::printf("%s", about) < 0 ? 1 : 0;
  try {
    const int code = run(parse(arguments));
    std::fflush(nullptr);
    // FCL and Coal each link their own octomap, whose destructors collide at exit.
    std::quick_exit(code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

}  // namespace

}  // namespace repel::scale

int main(int argc, char** argv) {
  return repel::scale::start(argc, argv);
}
