// SPDX-License-Identifier: BSD-3-Clause
// Period of a pendulum compared with the complete elliptic integral.

#include <cmath>

#include "../distance/markdown.hpp"
#include "arms.hpp"
#include "part.hpp"

namespace repel::engines {

namespace {

constexpr int swings = 20;
constexpr double reference_error = 1e-9;  // relative error of the period, upper limit

/// The zero of the cubic Hermite interpolant of a step, as a fraction of the step.
double crossing(double q0, double v0, double q1, double v1) {
  const double d0 = period * v0;
  const double d1 = period * v1;
  double low = 0.0;
  double high = 1.0;
  while (high - low > 1e-15) {
    const double s = 0.5 * (low + high);
    const double r = 1.0 - s;
    const double q =
        r * r * ((1.0 + 2.0 * s) * q0 + s * d0) + s * s * ((1.0 + 2.0 * r) * q1 - r * d1);
    (q > 0.0 ? low : high) = s;
  }
  return low;
}

/// Period of a swing [s], averaged over 20 between crossings of the vertical in one direction; NaN
/// if it does not swing.
double measured_period(SimulatedArm& arm, double amplitude, double expected) {
  arm.reset(std::vector{amplitude}, {});
  double q0 = amplitude;
  double v0 = 0.0;
  double first = 0.0;
  int crossings = 0;
  const auto ticks = std::llround(2 * swings * expected / period);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    arm.step(period);
    const double q1 = arm.positions().front();
    const double v1 = arm.velocities().front();
    if (q0 > 0.0 && q1 <= 0.0) {
      const double now = period * (static_cast<double>(tick) + crossing(q0, v0, q1, v1));
      if (crossings == 0) first = now;
      if (crossings++ == swings) return (now - first) / swings;
    }
    q0 = q1;
    v0 = v1;
  }
  return NAN;
}

void measure(double degrees, Result& result) {
  const double amplitude = degrees * M_PI / 180.0;
  const double exact = 4.0 * std::comp_ellint_1(std::sin(0.5 * amplitude)) / pendulum_frequency();
  for (const Engine& engine : engines()) {
    double before = &engine == &reference() ? reference_error : INFINITY;
    for (const int substeps : {1, 4, 16}) {
      const auto arm = engine.make(pendulum(), substeps);
      const double error = measured_period(*arm, amplitude, exact) / exact - 1.0;
      result.rows.push_back({degrees, engine.name, substeps, exact, error});
      if (!(std::abs(error) < reference_error || std::abs(error) < before / 2)) {
        result.fail(
            bench::text("%g degrees, %s, %d sub-steps", degrees, engine.name.c_str(), substeps),
            "the error is too large or does not fall with the sub-steps");
      }
      before = std::abs(error);
    }
  }
}

}  // namespace

Result swing_period(const Options& /*options*/) {
  Result result{
      .title = "Period of a pendulum",
      .columns = {"amplitude [deg]", "engine", "sub-steps", "exact [s]", "relative error"},
      .notes = {bench::text("The relative error of the mean period of %d swings from rest; the "
                            "exact period is 4 K(sin(amplitude / 2)) / omega.",
                            swings)}};
  for (const double degrees : {5.0, 120.0}) measure(degrees, result);
  return result;
}

}  // namespace repel::engines
