// SPDX-License-Identifier: BSD-3-Clause
// Quantitative checks of Figures 3, 5, 6 and 8 of Anderson 1993; docs/reduction.md has the plots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../../docs/figures/motions.hpp"
#include "../../docs/figures/plates.hpp"
#include "../../docs/figures/settled.hpp"

namespace repel::figures {
namespace figures_test {

constexpr double degree = std::numbers::pi / 180.0;
constexpr int steps = 7700;  // in every motion one of them is exactly contact

std::vector<Sample> through(int levels) {
  return answers_along(through_a_rectangle(levels), Measure::reduction, steps);
}
std::vector<Sample> through_by_deepest_point() {
  return answers_along(through_a_rectangle(8), Measure::deepest_point, steps);
}

/// `swing` [deg] is the largest reversal of the direction allowed between consecutive samples.
void expect_turning_from_back_to_up(const std::vector<Sample>& samples, double swing = 1e-6) {
  EXPECT_NEAR(samples.front().direction(), 180.0, 1e-9);
  EXPECT_NEAR(samples.back().direction(), 90.0, 1e-9);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_LE(samples[i].direction(), samples[i - 1].direction() + swing)
        << "at " << samples[i].position << " m";
  }
}

bool has_an_angle_in_between(const std::vector<Sample>& samples) {
  return std::any_of(samples.begin(), samples.end(),
                     [](const Sample& s) { return s.direction() > 95.0 && s.direction() < 175.0; });
}

void expect_no_faster_than_the_motion(const std::vector<Sample>& samples) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = samples[i].position - samples[i - 1].position;
    ASSERT_LE(std::abs(samples[i].distance() - samples[i - 1].distance()), step + 1e-12)
        << "at " << samples[i].position << " m";
  }
}

void expect_never_rising_until_the_deepest(const std::vector<Sample>& samples) {
  for (std::size_t i = 1; i <= deepest_of(samples); ++i) {
    ASSERT_LE(samples[i].distance(), samples[i - 1].distance() + 1e-13)
        << "at " << samples[i].position << " m";
  }
}

TEST(Figure3, ByLevelsTheWayOutTurnsFromBackOverAnAngleToUp) {
  for (const int levels : {2, 4, 8, 32}) {
    SCOPED_TRACE(std::to_string(levels) + " levels");
    const auto straight = answers_along(into_a_box(levels), Measure::reduction, steps);
    expect_turning_from_back_to_up(straight);
    EXPECT_TRUE(has_an_angle_in_between(straight));
    const Motion turned = into_a_box(levels, 20.0 * degree);
    // When other levels become decisive, the direction of a rotated box may reverse a little.
    expect_turning_from_back_to_up(answers_along(turned, Measure::reduction, steps), 15.0);
  }
}

TEST(Figure3, ByDeepestPointTheWayOutTurnsFromBackToUp) {
  const auto straight = answers_along(into_a_box(8), Measure::deepest_point, steps);
  expect_turning_from_back_to_up(straight);
  // All planes are normal to the axes: no intermediate direction is possible.
  EXPECT_FALSE(has_an_angle_in_between(straight));
  const auto turned = answers_along(into_a_box(8, 20.0 * degree), Measure::deepest_point, steps);
  expect_turning_from_back_to_up(turned);
  EXPECT_TRUE(has_an_angle_in_between(turned));
}

TEST(Figure3, TheDistanceChangesNoFasterThanTheMotion) {
  for (const double turned : {0.0, 20.0 * degree}) {
    for (const Measure measure : {Measure::reduction, Measure::deepest_point}) {
      expect_no_faster_than_the_motion(answers_along(into_a_box(8, turned), measure, steps));
    }
  }
}

TEST(Figure5, TheTriangleIsPushedBackThenUpThenOn) {
  for (const auto& samples : {through(8), through_by_deepest_point()}) {
    EXPECT_NEAR(samples.front().direction(), 180.0, 1e-9);
    EXPECT_NEAR(samples[steps / 2].direction(), 90.0, 1e-9);
    EXPECT_NEAR(samples.back().direction(), 0.0, 1e-9);
  }
}

TEST(Figure6, TheDistanceChangesNoFasterThanTheMotion) {
  for (const int levels : {1, 2, 8, 32}) expect_no_faster_than_the_motion(through(levels));
  expect_no_faster_than_the_motion(through_by_deepest_point());
}

TEST(Figure6, TheDistanceNeverRisesUntilTheDeepestPosition) {
  for (const int levels : {1, 2, 8, 32}) expect_never_rising_until_the_deepest(through(levels));
  expect_never_rising_until_the_deepest(through_by_deepest_point());
}

TEST(Figure6, EquidistanceRegionsNarrowAsLevelsGrow) {
  EXPECT_GT(widest_flat(through(2)), 0.010);
  double wider = widest_flat(through(2));
  for (const int levels : {4, 8, 16, 32}) {
    const double widest = widest_flat(through(levels));
    EXPECT_LT(widest, 0.6 * wider) << levels << " levels";
    EXPECT_GT(widest, 0.0) << levels << " levels";
    wider = widest;
  }
}

TEST(Figure6, TheDeepestPointHasNoEquidistanceRegion) {
  EXPECT_EQ(widest_flat(through_by_deepest_point()), 0.0);
}

TEST(Figure6, TheDeepestPointIsNeverShallowerThanTheLevels) {
  const auto deepest_point = through_by_deepest_point();
  for (const int levels : {2, 8, 32}) {
    const auto reduction = through(levels);
    for (std::size_t i = 0; i < reduction.size(); ++i) {
      ASSERT_LE(deepest_point[i].distance(), reduction[i].distance() + 1e-12);
    }
  }
}

const std::vector<PlatesOptions> presses{
    {},
    {.held = true},
    {.press = 150.0, .held = true},
    {.measure = Measure::deepest_point, .press = 150.0, .held = true}};

TEST(Figure8, HeldPlatesStayParallelWhileTheWitnessPointRaces) {
  for (const double rate : {400.0, 1000.0}) {
    const Settled s = settled(Plates({.rate = rate, .held = true}).run(), rate);
    EXPECT_LT(s.tilt, 0.1 * degree);
    EXPECT_LT(s.pushed_tilt, 0.25 * degree);
    EXPECT_GT(s.torque_jump, 1.0);  // stated in docs/reduction.md for the plain witness point
  }
}

TEST(Figure8, PlatesComeToRestInParallelWithAnAveragedWitnessPoint) {
  for (PlatesOptions options : presses) {
    options.witness = Witness::averaged;
    for (const double rate : {400.0, 1000.0}) {
      options.rate = rate;
      SCOPED_TRACE(std::to_string(options.press) + " N at " + std::to_string(rate) + " Hz");
      const auto ticks = Plates(options).run();
      const Settled s = settled(ticks, rate);
      EXPECT_LT(s.tilt, 1e-6);
      EXPECT_LT(s.chatter, 1e-5);
      EXPECT_LT(s.torque_jump, 1e-6);
      EXPECT_LT(s.speed, 1e-6);
      EXPECT_LT(s.pushed_tilt, 1.5 * degree);
      EXPECT_NEAR(ForceLaw{}.spring(ticks.back().height), options.press, 1e-3 * options.press);
    }
  }
}

TEST(Figure8, WhatIsAboveTheCutoffIsCountedAndWhatIsBelowIsNot) {
  std::vector<double> values;
  for (int k = 0; k < 1000; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / 1000.0;
    values.push_back(7.0 + 3.0 * std::sin(10.0 * turn) + 2.0 * std::sin(50.0 * turn));
  }
  EXPECT_NEAR(rms_above(30.0, values, 1000.0), std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(rms_above(5.0, values, 1000.0), std::sqrt(6.5), 1e-9);
}

}  // namespace figures_test
}  // namespace repel::figures
