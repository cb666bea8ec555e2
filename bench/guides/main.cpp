// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What virtual fixtures do for a hand that trembles: time and error of two tasks.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "../parts.hpp"
#include "trial.hpp"

namespace {

using namespace repel;
using namespace repel::guides;

/// Fixtures to compare.
struct Case {
  std::string name;
  std::string fixtures;  ///< YAML
};

std::vector<Case> cases_of(Task task) {
  if (task == Task::seam) {
    const std::string path = "shape: path, points: " + seam_points();
    const std::string plane = "{name: plane, shape: plane, position: 0 0 0.44 m}";
    return {
        {"none", ""},
        {"path, 300 N/m", "{name: path, " + path + ", stiffness: 300 N/m}"},
        {"path, 1000 N/m", "{name: path, " + path + "}"},
        {"path, hard", "{name: path, " + path + ", stiffness: auto, most_force: 60 N}"},
        {"tube of 1 mm, hard", "{name: tube, shape: tube, radius: 1 mm, points: " + seam_points() +
                                   ", stiffness: auto, most_force: 60 N}"},
        {"plane, 1000 N/m", plane},
        {"plane, and path of 300 N/m", plane + ", {name: path, " + path + ", stiffness: 300 N/m}"}};
  }
  const std::string at = "position: 0.6 -0.15 0.45 m";
  const std::string axis = "{name: axis, shape: axis, rpy: 180 0 0 deg, " + at;
  const std::string cone =
      "{name: cone, shape: cone, half_angle: 2 deg, position: 0.6 -0.15 0.385 m, stiffness: "
      "auto, most_force: 60 N}";
  return {{"none", ""},
          {"line, 1000 N/m", "{name: line, shape: line, " + at + "}"},
          {"axis, 1000 N/m", axis + "}"},
          {"axis, hard", axis + ", stiffness: auto, angular_stiffness: auto, most_force: 60 N}"},
          {"cone of 2 degrees, hard", cone},
          {"that cone, and axis of 1000 N/m", cone + ", " + axis + "}"}};
}

/// A mean and half of its interval of 95 %.
struct Mean {
  double mean = 0.0, half = 0.0;
};

// The quantile of Student's distribution to 0.002 for 7 and more degrees of freedom, by its series.
Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean result;
  for (const double value : values) result.mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  const double v = n - 1.0;
  if (v > 0.0) {
    const double t = 1.95996 + 2.37227 / v + 2.82250 / (v * v) + 2.5556 / (v * v * v);
    result.half = t * std::sqrt(squares / v / n);
  }
  return result;
}

/// Checks that the hand is as unsteady as it says, and that without unrest both tasks are done
/// well. Empty when they are.
std::string senseless() {
  const HandOptions options;
  Unrest unrest(options, 7);
  double wander = 0.0, tremor = 0.0;
  constexpr int ticks = 400000;
  for (int tick = 0; tick < ticks; ++tick) {
    unrest.step(0.0025);
    wander += squared_norm(unrest.wander()) / (3.0 * ticks);
    tremor += squared_norm(unrest.tremor()) / (3.0 * ticks);
  }
  if (std::abs(std::sqrt(wander) / options.wander - 1.0) > 0.15) return "the wander is off";
  if (std::abs(std::sqrt(tremor) / options.tremor - 1.0) > 0.02) return "the tremor is off";
  HandOptions calm;
  calm.wander = calm.tremor = calm.turning = 0.0;
  for (const Task task : {Task::seam, Task::peg}) {
    const Outcome outcome = run(task, "", calm, 1);
    if (!outcome.is_done) return "a calm hand does not get there";
    if (!outcome.complaint.empty()) return outcome.complaint;
    if (outcome.error > 4e-3) return "a calm hand is not calm";
  }
  return {};
}

bench::Result measure(Task task, const char* title, const bench::Options& options) {
  bench::Result result;
  result.title = title;
  result.columns = {"fixtures",   "time [s]", "time +-",      "error [mm]", "error +-",
                    "worst [mm]", "worst +-", "fixtures [N]", "walls [N]",  "done"};
  const int seeds = options.quick ? 2 : 30;
  const std::vector<Case> cases = cases_of(task);
  if (task == Task::seam) result.fail("the hand", senseless());
  std::size_t done = 0;
  for (const Case& each : cases) {
    std::vector<double> times, errors, worst;
    double guide = 0.0, walls = 0.0;
    int finished = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const Outcome outcome =
          run(task, each.fixtures, {}, options.seed + static_cast<std::uint64_t>(seed));
      result.fail(each.name, outcome.complaint);
      times.push_back(outcome.time);
      errors.push_back(1e3 * outcome.error);
      worst.push_back(1e3 * outcome.worst);
      guide = std::max(guide, outcome.guide_force);
      walls = std::max(walls, outcome.wall_force);
      finished += outcome.is_done ? 1 : 0;
      bench::progress(task == Task::seam ? "seam" : "peg", ++done, cases.size() * seeds);
    }
    const Mean time = mean_of(times), error = mean_of(errors), most = mean_of(worst);
    result.rows.push_back({each.name, time.mean, time.half, error.mean, error.half, most.mean,
                           most.half, guide, walls,
                           std::to_string(finished) + " of " + std::to_string(seeds)});
  }
  result.notes = {
      "Means over the seeds, each with half of its interval of 95 %. The error is the root mean "
      "square distance from the way in a run, `worst` its largest; forces are the largest of all "
      "runs."};
  return result;
}

bench::Result seam_part(const bench::Options& options) {
  return measure(Task::seam, "Along a seam of 0.38 m", options);
}
bench::Result peg_part(const bench::Options& options) {
  return measure(Task::peg, "A peg into a hole with 3 mm of play", options);
}

constexpr std::array<bench::Part, 2> all{
    bench::Part{"seam", "a spline is followed, with and without fixtures", seam_part},
    bench::Part{"peg", "a peg is put into a hole, with and without fixtures", peg_part}};
constexpr bench::Program program{
    "guides",
    "What virtual fixtures do for a hand that trembles and strays.",
    all,
    "of the first hand",
    "Everything is simulated, the operator too: nothing waits for the clock, and a seed gives the\n"
    "same results again. docs/benchmarks.md describes the operator.",
    "simulated time"};

}  // namespace

int main(int argc, char** argv) {
  return repel::bench::start<program>(argc, argv);
}
