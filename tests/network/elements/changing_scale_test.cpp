// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/changing_scale.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace repel::network {
namespace changing_scale_test {

TEST(ChangingScale, TakesTheFirstOverAtOnceAndFollowsTheNext) {
  ChangingScale scale;
  scale.prepare(0.0025);
  EXPECT_EQ(scale.value(), 1.0);
  scale.step(0.5);
  EXPECT_EQ(scale.value(), 0.5);
  for (int tick = 0; tick < 120; ++tick) scale.step(2.5);  // 0.3 s
  EXPECT_NEAR(scale.value(), 2.5 - 2.0 * std::exp(-1.0), 1e-9);
  for (int tick = 0; tick < 4000; ++tick) scale.step(2.5);
  EXPECT_NEAR(scale.value(), 2.5, 1e-9);
}

TEST(ChangingScale, IsTheSameInTimeAtAnyRate) {
  for (const double period : {0.01, 0.0025, 0.00025}) {
    ChangingScale scale;
    scale.prepare(period);
    scale.step(1.0);
    const int ticks = static_cast<int>(std::lround(0.6 / period));
    for (int tick = 0; tick < ticks; ++tick) scale.step(3.0);
    EXPECT_NEAR(scale.value(), 3.0 - 2.0 * std::exp(-2.0), 1e-9) << period;
  }
}

TEST(ChangingScale, WhatIsNoScaleChangesNothing) {
  ChangingScale scale;
  scale.prepare(0.0025);
  scale.step(0.5);
  for (const double wrong : {0.0, -1.0, 1e4, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    scale.step(wrong);
    EXPECT_EQ(scale.value(), 0.5) << wrong;
  }
}

}  // namespace changing_scale_test
}  // namespace repel::network
