// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/failsafe.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace repel {
namespace failsafe_test {

constexpr double period = 0.0025;
constexpr unsigned seed = 112;
const FailsafeOptions options;  // fall 0.05 s, hold 0.25 s, rise 0.5 s

TEST(Failsafe, SoundInputsHaveTheWholeForce) {
  Failsafe failsafe;
  for (int tick = 0; tick < 1000; ++tick) {
    EXPECT_EQ(failsafe.step(0, period), 1.0);
    EXPECT_FALSE(failsafe.tripped());
  }
}

TEST(Failsafe, WarningsDoNotTrip) {
  Failsafe failsafe;
  const Status warnings = status::stale_pairs | status::late_result | status::torque_limit;
  for (int tick = 0; tick < 100; ++tick) EXPECT_EQ(failsafe.step(warnings, period), 1.0);
}

TEST(Failsafe, EachFaultTrips) {
  for (const Status fault :
       {status::bad_pose, status::bad_command, status::bad_joints, status::clock_fault}) {
    Failsafe failsafe;
    EXPECT_LT(failsafe.step(fault, period), 1.0);
    EXPECT_TRUE(failsafe.tripped());
  }
}

TEST(Failsafe, FallsHoldsAndRisesInTheStatedTimes) {
  Failsafe failsafe(options);
  double gain = failsafe.step(status::bad_pose, period);
  int ticks = 1;
  for (; gain > 0.0; ++ticks) gain = failsafe.step(0, period);
  EXPECT_NEAR(ticks * period, options.fall, 1.5 * period);
  for (; gain == 0.0; ++ticks) {
    EXPECT_TRUE(failsafe.tripped());
    gain = failsafe.step(0, period);
  }
  EXPECT_NEAR(ticks * period, options.hold, 2.5 * period);
  EXPECT_FALSE(failsafe.tripped());
  int rising = 1;
  for (; gain < 1.0; ++rising) gain = failsafe.step(0, period);
  EXPECT_NEAR(rising * period, options.rise, 1.5 * period);
}

TEST(Failsafe, HoldsAsLongAsTheFaultLastsAndThenTheWholeTime) {
  Failsafe failsafe(options);
  for (int tick = 0; tick < 1000; ++tick) (void)failsafe.step(status::bad_joints, period);
  int held = 0;
  while (failsafe.step(0, period) == 0.0) ++held;
  EXPECT_NEAR(held * period, options.hold, 1.5 * period);
}

TEST(Failsafe, FaultWhileRisingFallsFromThereAndHoldsAnew) {
  Failsafe failsafe(options);
  (void)failsafe.step(status::bad_pose, period);
  double gain = 0.0;
  for (int tick = 0; tick < 200; ++tick) gain = failsafe.step(0, period);
  ASSERT_GT(gain, 0.2);
  ASSERT_LT(gain, 0.8);
  const double next = failsafe.step(status::bad_pose, period);
  EXPECT_LT(next, gain);
  int held = 0;
  for (; held < 90; ++held) (void)failsafe.step(0, period);
  EXPECT_EQ(failsafe.step(0, period), 0.0);
}

TEST(Failsafe, GainStaysBetweenZeroAndOneAndNeverJumps) {
  std::mt19937_64 random(seed);
  for (int run = 0; run < 100; ++run) {
    Failsafe failsafe(options);
    double last = 1.0;
    const double share = run % 10 == 0 ? 0.5 : 0.005;
    bool whole = false;
    for (int tick = 0; tick < 2000; ++tick) {
      const bool fault = std::bernoulli_distribution(share)(random);
      const double gain = failsafe.step(fault ? status::bad_command : 0U, period);
      ASSERT_GE(gain, 0.0) << "seed " << seed;
      ASSERT_LE(gain, 1.0) << "seed " << seed;
      ASSERT_LE(gain - last, period / options.rise + 1e-12) << "seed " << seed;
      ASSERT_LE(last - gain, period / options.fall + 1e-12) << "seed " << seed;
      if (fault) {
        ASSERT_TRUE(gain < last || gain == 0.0) << "seed " << seed;
      }
      whole = whole || gain == 1.0;
      last = gain;
    }
  }
}

}  // namespace failsafe_test
}  // namespace repel
