// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/rate_check.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace repel {
namespace rate_check_test {

constexpr double T = 0.0025;

/// Ticks until the rates of a joint that moves to and fro by `speed` [rad/s] contradict its
/// positions, where it tells `told` of its rate; -1: never.
template <class Told>
int noticed(double speed, const Told& told, double* untold = nullptr) {
  RateCheck check;
  double last = told(0.0);
  for (int tick = 1; tick < 4000; ++tick) {
    const double v = speed * std::sin(2.0 * tick * T);
    const double now = told(v);
    if (!check.step(T * v, last, now, T, false, {}, T)) return tick;
    if (untold != nullptr) *untold = std::max(*untold, std::abs(check.untold()));
    last = now;
  }
  return -1;
}

TEST(RateCheck, RatesThatAreRightAreNeverInDoubt) {
  double untold = 0.0;
  EXPECT_EQ(noticed(
                1.0, [](double v) { return v; }, &untold),
            -1);
  EXPECT_EQ(untold, 0.0);
}

// Inverted rates drove an arm 150 mm into a hard wall, dead ones 56 mm.
TEST(RateCheck, RatesThatAreNoneAreNoticedWithinMillimetres) {
  const auto way = [](int ticks) { return 0.25 * ticks * T; };  // at most [m]
  const auto at_once = [](double told) {
    RateCheck check;
    for (int tick = 1; tick < 400; ++tick) {
      if (!check.step(T * 0.25, told, told, T, false, {}, T)) return tick;
    }
    return -1;
  };
  for (const double told : {-0.25, 0.0, 0.125, 0.5}) {
    const int ticks = at_once(told);
    ASSERT_GT(ticks, 0) << told;
    EXPECT_LT(way(ticks), 0.02) << told;
  }
  EXPECT_LT(way(at_once(0.0)), 0.005);
}

TEST(RateCheck, UntilThenThePositionsTellTheRate) {
  RateCheck check;
  ASSERT_TRUE(check.step(T * 0.25, 0.0, 0.0, T, false, {}, T));
  EXPECT_NEAR(check.untold(), 0.25, 1e-12);
  ASSERT_TRUE(check.step(T * 0.25, 0.0, 0.0, T, false, {}, T));
  EXPECT_NEAR(check.untold_before(), 0.25, 1e-12);
}

// Noise of 1 mm was taken for a motion at 0.5 m/s, and the barrier threw the arm 3 mm into the
// wall.
TEST(RateCheck, NoiseAndASlipAreNoRateThatWasNotTold) {
  RateCheck check;
  double noise = 0.9e-3;
  for (int tick = 0; tick < 3; ++tick, noise = -noise) {
    ASSERT_TRUE(check.step(0.0, 0.0, 0.0, T, false, {}, T));
    EXPECT_EQ(check.untold(), 0.0);
  }
  ASSERT_TRUE(check.step(noise, 0.0, 0.0, T, false, {}, T));
  EXPECT_LT(std::abs(check.untold()), 0.15);
}

TEST(RateCheck, AScaleOfFourPercentIsWithinTheNoise) {
  EXPECT_EQ(noticed(0.5, [](double v) { return 1.03 * v; }), -1);
  EXPECT_GT(noticed(0.5, [](double v) { return 1.3 * v; }), 0);
}

}  // namespace rate_check_test
}  // namespace repel
