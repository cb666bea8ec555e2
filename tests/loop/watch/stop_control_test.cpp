// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/stop_control.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace stop_control_test {

constexpr double period = 0.0025;

TEST(StopControl, RunsWithoutAFaultAndHoldsWithOne) {
  StopControl control(period, {});
  EXPECT_EQ(control.step(false, false, false, period), Stop::running);
  EXPECT_EQ(control.step(false, false, true, period), Stop::holding);
  EXPECT_FALSE(control.brakes());
}

TEST(StopControl, AsksForTheBrakesOnceTheMotionHasBeenPredictedForTwentyMilliseconds) {
  StopControl control(period, {});
  for (int tick = 1; tick <= 300; ++tick) {
    const Stop stop = control.step(true, false, true, period);
    if (tick == 200) continue;  // at 0.5 s, to rounding
    EXPECT_EQ(stop, tick > 200 ? Stop::released : Stop::braking) << tick;
    EXPECT_EQ(control.brakes(), tick * period > 0.02 + 1e-9) << tick;
  }
}

TEST(StopControl, PredictsForThreeTicksAtLeast) {
  StopControl control(0.01, {});
  for (int tick = 1; tick <= 5; ++tick) {
    (void)control.step(true, false, true, 0.01);
    EXPECT_EQ(control.brakes(), tick > 3) << tick;
  }
}

TEST(StopControl, BrakesStayUntilTheOperatorComesBack) {
  StopControl control(period, {});
  for (int tick = 0; tick < 20; ++tick) (void)control.step(true, false, true, period);
  EXPECT_EQ(control.step(false, false, true, period), Stop::braking);
  EXPECT_TRUE(control.brakes());
  EXPECT_EQ(control.step(false, false, false, period), Stop::running);
  EXPECT_FALSE(control.brakes());
}

TEST(StopControl, AnArmThatWasNeverSeenIsReleasedAndBrakedAtOnce) {
  StopControl control(period, {});
  EXPECT_EQ(control.step(true, true, true, period), Stop::released);
  EXPECT_TRUE(control.brakes());
}

}  // namespace stop_control_test
}  // namespace repel
