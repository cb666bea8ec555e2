// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/signals.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace signals_test {

constexpr unsigned seed = 43;

TEST(Signals, FlowOfTheToolIsTheJacobianTimesTheRates) {
  for (const int joints : {1, 6, 16}) {
    test::Rng rng(seed);
    test::DrawnSignals drawn(rng, joints);
    for (int tick = 0; tick < 1000; ++tick) {
      const Signals& s = drawn.next();
      ASSERT_EQ(s.tool_flow().size(), 6);
      EXPECT_LE((s.tool_flow() - s.jacobian * s.rates).norm(), 1e-12) << "seed " << seed;
      EXPECT_LE((s.mean_tool_flow() - s.jacobian * s.mean_rates).norm(), 1e-12) << "seed " << seed;
    }
    EXPECT_GT(drawn.signals.jacobian.norm(), 0.5);
  }
}

TEST(Signals, BeginAtRestWithNothingInTheHand) {
  const Signals signals;
  EXPECT_FALSE(signals.at_rest);
  EXPECT_EQ(signals.hand.lever_rate, 0.0);
  EXPECT_EQ(signals.hand.ball.linear, Vec3::Zero());
  EXPECT_EQ(signals.hand.direction_W.norm(), 1.0);
  EXPECT_EQ(signals.walls.force, Vec3::Zero());
  EXPECT_EQ(signals.joints.size(), 0);
}

}  // namespace signals_test
}  // namespace repel::network
