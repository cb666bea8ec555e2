// SPDX-License-Identifier: BSD-3-Clause
// The same motion simulated by every engine with an increasing number of sub-steps: time per step
// and error of the joint positions.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "../distance/markdown.hpp"
#include "arms.hpp"
#include "part.hpp"

namespace repel::engines {

namespace {

constexpr int ticks = 400;  // 1 s
constexpr int true_substeps =
    128;  // of the reference solution against which the others are compared
constexpr double converged = 1e-9;  // [rad] tolerance for its change when its sub-steps are halved
constexpr double least_gain =
    1.5;  // error ratio when the sub-steps are doubled; a first-order method has 2

using Motion = std::vector<std::vector<double>>;  // joint positions [rad], tick by tick

struct Workload {
  std::string name;
  ArmModel model;
  std::vector<double> start;                 // [rad], at rest
  std::vector<std::vector<double>> torques;  // [N m], tick by tick
};

Workload puma_under_slow_torques() {
  Workload workload{"PUMA 560", puma(), {0.2, 0.9, 0.1, -0.3, 0.4, 0.5}, {}};
  for (int tick = 0; tick < ticks; ++tick) {
    const double s = std::sin(0.02 * tick);
    workload.torques.push_back({10.0 * s, 45.0 - 20.0 * s, 8.0 * s, s, -s, 0.5 * s});
  }
  return workload;
}

Workload free_pendulum() {
  return {"pendulum", pendulum(), {1.0}, {ticks, std::vector{0.0}}};
}

Motion motion_of(SimulatedArm& arm, const Workload& workload) {
  Motion motion;
  arm.reset(workload.start, {});
  for (const std::vector<double>& torques : workload.torques) {
    arm.set_torques(torques);
    arm.step(period);
    motion.push_back(arm.positions());
  }
  return motion;
}

/// Largest difference of a joint position at any tick [rad].
double apart(const Motion& a, const Motion& b) {
  double most = 0.0;
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    for (std::size_t i = 0; i < a[tick].size(); ++i) {
      const double error = std::abs(a[tick][i] - b[tick][i]);
      if (!(error <= most)) most = error;  // also true for NaN
    }
  }
  return most;
}

/// One engine with one number of sub-steps on one workload.
struct Run {
  const Engine& engine;
  int substeps;
  std::unique_ptr<SimulatedArm> arm;
  double error = 0.0;                // [rad]
  std::vector<double> step_times{};  // [s] mean of each timed motion
};

double seconds_per_step(SimulatedArm& arm, const Workload& workload) {
  using Clock = std::chrono::steady_clock;
  arm.reset(workload.start, {});
  const auto begin = Clock::now();
  for (const std::vector<double>& torques : workload.torques) {
    arm.set_torques(torques);
    arm.step(period);
  }
  return std::chrono::duration<double>(Clock::now() - begin).count() / ticks;
}

std::size_t repetitions_of(const Options& options) {
  return options.quick ? 3 : 51;
}

/// Interleaves all runs, in a different order each time, so that disturbances of the machine affect
/// all alike.
void time_all(std::vector<Run>& runs, const Workload& workload, const Options& options) {
  std::mt19937_64 random(options.seed);
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t repetitions = repetitions_of(options);
  for (std::size_t i = 0; i < repetitions; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t k : order) {
      runs[k].step_times.push_back(seconds_per_step(*runs[k].arm, workload));
    }
    progress(("sweep, " + workload.name).c_str(), i + 1, repetitions);
  }
  for (Run& run : runs) std::sort(run.step_times.begin(), run.step_times.end());
}

/// Every engine with every number of sub-steps, with its error, not timed yet.
std::vector<Run> runs_of(const Workload& workload, const Motion& truth, const Options& options) {
  std::vector<Run> runs;
  for (const Engine& engine : engines()) {
    for (int substeps = 1; substeps <= (options.quick ? 4 : 32); substeps *= 2) {
      runs.push_back({engine, substeps, engine.make(workload.model, substeps)});
      runs.back().error = apart(motion_of(*runs.back().arm, workload), truth);
    }
  }
  return runs;
}

/// The fault of `run`, or an empty string. `before` [rad]: error of its engine with half the
/// sub-steps; `doubt` [rad]: uncertainty of the reference.
std::string complaint(const Run& run, double before, double doubt) {
  if (!(doubt < converged)) return "the reference has not converged";
  if (run.error < converged || run.error < before / least_gain) return "";
  return "the error does not fall with the sub-steps";
}

/// A run with a complaint gets no time in the table.
void add_row(const Workload& workload, const Run& run, const std::string& why, Result& result) {
  const auto earned = [&](double time) { return why.empty() ? Json(1e6 * time) : Json(); };
  const std::string& engine = run.engine.name;
  result.rows.push_back({workload.name, engine, run.substeps, 1e3 * run.error,
                         earned(run.step_times[run.step_times.size() / 2]),
                         earned(run.step_times.front())});
  result.fail(workload.name + ", " + engine + ", " + std::to_string(run.substeps) + " sub-steps",
              why);
}

void measure(const Workload& workload, const Options& options, Result& result) {
  const auto reference_in = [&workload](int substeps) {
    return motion_of(*reference().make(workload.model, substeps), workload);
  };
  const Motion truth = reference_in(true_substeps);
  const double doubt = apart(truth, reference_in(true_substeps / 2));
  result.notes.push_back(
      bench::text("%s: with half the sub-steps the reference changes by %.1e mrad.",
                  workload.name.c_str(), 1e3 * doubt));
  std::vector<Run> runs = runs_of(workload, truth, options);
  time_all(runs, workload, options);
  double before = INFINITY;
  for (const Run& run : runs) {
    if (run.substeps == 1) before = INFINITY;
    add_row(workload, run, complaint(run, before, doubt), result);
    before = run.error;
  }
}

}  // namespace

Result sweep(const Options& options) {
  Result result{
      .title = "Run time against error",
      .columns = {"arm", "engine", "sub-steps", "error [mrad]", "step [us]", "fastest step [us]"},
      .notes = {
          bench::text("A second in steps of 2.5 ms. The error is the greatest of any joint at any "
                      "step, against the reference arm with %d sub-steps; the time of a step is "
                      "the median and the minimum of %zu such seconds. " REPEL_ENGINES ".",
                      true_substeps, repetitions_of(options))}};
  measure(puma_under_slow_torques(), options, result);
  measure(free_pendulum(), options, result);
  return result;
}

}  // namespace repel::engines
