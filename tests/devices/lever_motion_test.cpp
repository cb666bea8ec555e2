// SPDX-License-Identifier: BSD-3-Clause
// The rate of a lever from counts and time stamps.
#include <repel/devices/lever_motion.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace repel::devices {
namespace lever_motion_test {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

constexpr LeverScale scale{.low = -1000,
                           .high = 1000,
                           .fuzz = 0,
                           .full_range = 2.0,
                           .time_constant = 0.02,
                           .max_rate = 20.0};

TEST(LeverMotion, TheAngleIsTheFullRangeOverTheCounts) {
  LeverMotion lever(scale);
  lever.place(1000, nanoseconds(0));
  EXPECT_DOUBLE_EQ(lever.angle(), 1.0);
  lever.place(-500, nanoseconds(0));
  EXPECT_DOUBLE_EQ(lever.angle(), -0.5);
  lever.place(5000, nanoseconds(0));  // beyond the range stated by the kernel
  EXPECT_DOUBLE_EQ(lever.angle(), 1.0);
  EXPECT_EQ(lever.rate(nanoseconds(0)), 0.0);
}

TEST(LeverMotion, ConvergesToASteadyRateWithItsTimeConstant) {
  LeverMotion lever(scale);
  nanoseconds now(0);
  lever.place(0, now);
  for (int i = 1; i <= 10; ++i) {  // 4 counts in 2 ms: 2 rad/s, for one time constant
    now += microseconds(2000);
    lever.move(4 * i, now);
  }
  EXPECT_NEAR(lever.rate(now), 2.0 * (1.0 - std::pow(1.0 / 1.1, 10)), 1e-9);
  for (int i = 11; i <= 100; ++i) {
    now += microseconds(2000);
    lever.move(4 * i, now);
  }
  EXPECT_NEAR(lever.rate(now), 2.0, 1e-3);
}

TEST(LeverMotion, ComesToRestWhenNothingComes) {
  LeverMotion lever(scale);
  nanoseconds now(0);
  lever.place(0, now);
  for (int i = 1; i <= 100; ++i) lever.move(4 * i, now += microseconds(2000));
  const double moving = lever.rate(now);
  EXPECT_EQ(lever.rate(now + microseconds(20000)), moving);
  double before = moving;
  for (int ms = 21; ms < 2000; ++ms) {
    const double rate = lever.rate(now + microseconds(1000 * ms));
    EXPECT_LE(rate, before);
    EXPECT_LE(rate, 0.001 / (0.001 * ms - 0.02) + 1e-12);  // a count is 0.001 rad
    before = rate;
  }
  EXPECT_EQ(before, 0.0);
}

TEST(LeverMotion, ATimeThatDoesNotRunOnIsNotDividedBy) {
  LeverMotion lever(scale);
  lever.place(0, microseconds(10000));
  lever.move(100, microseconds(10000));
  lever.move(200, microseconds(5000));
  EXPECT_EQ(lever.rate(microseconds(10000)), 0.0);
  EXPECT_DOUBLE_EQ(lever.angle(), 0.2);
  lever.move(200, microseconds(30000));  // the change counts now: 0.2 rad in 20 ms, half of it
  EXPECT_DOUBLE_EQ(lever.rate(microseconds(30000)), 5.0);
}

TEST(LeverMotion, IsNeverFasterThanTheLargestRate) {
  LeverMotion lever(scale);
  lever.place(-1000, nanoseconds(0));
  nanoseconds now(0);
  for (int i = 0; i < 100; ++i) {
    lever.move(i % 2 == 0 ? 1000 : -1000, now += microseconds(200));
    EXPECT_LE(std::abs(lever.rate(now)), 20.0);
  }
}

}  // namespace lever_motion_test
}  // namespace repel::devices
