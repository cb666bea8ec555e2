// SPDX-License-Identifier: BSD-3-Clause
// Energy drift of arms without friction and torques, whose energy should be constant.

#include <algorithm>
#include <array>
#include <cmath>

#include "arms.hpp"
#include "part.hpp"

namespace repel::engines {

namespace {

constexpr int ticks_per_second = 400;
constexpr double reference_drift = 1e-9;  // relative energy drift in 1 s, upper limit

struct Fall {
  std::string name;
  ArmModel model;
  std::vector<double> start;  // [rad], at rest
};

/// Energy [J] after each tick; the kinetic energy also separately.
struct Course {
  std::vector<double> total, kinetic;
};

Course course_of(const Engine& engine, const Fall& fall, int substeps, int seconds) {
  const std::unique_ptr<SimulatedArm> arm = engine.make(fall.model, substeps);
  Energy energy(fall.model);
  arm->reset(fall.start, {});
  Course course{{energy.potential(fall.start)}, {0.0}};
  for (int tick = 0; tick < seconds * ticks_per_second; ++tick) {
    arm->step(period);
    const std::vector<double> q = arm->positions();
    course.kinetic.push_back(energy.kinetic(q, arm->velocities()));
    course.total.push_back(course.kinetic.back() + energy.potential(q));
  }
  return course;
}

/// Largest deviation of the energy from its initial value [J] until `seconds`.
double furthest(const std::vector<double>& total, int seconds) {
  double most = 0.0;
  for (int tick = 0; tick <= seconds * ticks_per_second; ++tick) {
    const double off = std::abs(total[static_cast<std::size_t>(tick)] - total.front());
    if (!(off <= most)) most = off;  // also true for NaN
  }
  return most;
}

/// Energy gained, as a mean over the last ten seconds, or over all if the run is shorter [J].
double gained(const std::vector<double>& total) {
  const std::size_t count = std::min(total.size(), std::size_t{10} * ticks_per_second);
  double sum = 0.0;
  for (auto it = total.end() - static_cast<std::ptrdiff_t>(count); it != total.end(); ++it) {
    sum += *it - total.front();
  }
  return sum / static_cast<double>(count);
}

void measure(const Fall& fall, const std::vector<int>& untils, Result& result) {
  const std::vector<double> kinetic = course_of(reference(), fall, 16, untils.back()).kinetic;
  const double scale = *std::max_element(kinetic.begin(), kinetic.end());
  for (const Engine& engine : engines()) {
    double before = &engine == &reference() ? reference_drift : INFINITY;
    for (const int substeps : {4, 16}) {
      const std::vector<double> total = course_of(engine, fall, substeps, untils.back()).total;
      std::vector<Json>& row = result.rows.emplace_back();
      row = {fall.name, engine.name, substeps};
      for (const int until : untils) row.emplace_back(furthest(total, until) / scale);
      row.emplace_back(gained(total) / scale);
      const double first = furthest(total, 1) / scale;
      if (!(first < reference_drift || first < before / 2)) {
        result.fail(fall.name + ", " + engine.name + ", " + std::to_string(substeps) + " sub-steps",
                    "its energy is too far off or does not come closer with the sub-steps");
      }
      before = first;
    }
  }
}

}  // namespace

Result energy(const Options& options) {
  const std::vector<int> untils = options.quick ? std::vector{1, 10} : std::vector{1, 10, 60};
  Result result{
      .title = "Energy of arms without friction",
      .columns = {"arm", "engine", "sub-steps"},
      .notes = {
          "Relative to the greatest kinetic energy of the reference arm. `off` is the greatest "
          "deviation from the initial energy, `gained` the mean deviation over the last 10 s."}};
  for (const int until : untils) {
    result.columns.push_back("off until " + std::to_string(until) + " s");
  }
  result.columns.emplace_back("gained at the end");
  const std::array falls{Fall{"pendulum from 120 degrees", pendulum(), {M_PI * 2.0 / 3.0}},
                         Fall{"three links of a PUMA", three_links(), {0.0, -1.2, 0.4}}};
  for (std::size_t i = 0; i < falls.size(); ++i) {
    measure(falls[i], untils, result);
    progress("energy", i + 1, falls.size());
  }
  return result;
}

}  // namespace repel::engines
