// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/hand_speed.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

namespace repel {
namespace hand_speed_test {

TEST(HandSpeed, AHandWhoseNumbersAreNoneRestsWhereItsLeverPointed) {
  network::HandInput last;
  last.direction_W = Vec3::UnitY();
  network::HandInput hand;
  hand.ball.linear = Vec3(0.1, 0, 0);
  EXPECT_TRUE(rest_unless_finite(hand, last));
  EXPECT_EQ(hand.ball.linear.x(), 0.1);
  hand.turning_W.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rest_unless_finite(hand, last));
  EXPECT_EQ(hand.ball.linear, Vec3::Zero());
  EXPECT_EQ(hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(hand.turning_W, Vec3::Zero());
}

TEST(HandSpeed, NoHandLeadsFasterThanTheToolMayBe) {
  network::HandInput hand;
  hand.ball.linear = Vec3(0.0, 0.1, 0.0);
  hand.lever_rate = 1.0;
  EXPECT_FALSE(cut_to_speed(hand, 0.25, 0.1));
  EXPECT_EQ(hand.ball.linear, Vec3(0.0, 0.1, 0.0));
  EXPECT_EQ(hand.lever_rate, 1.0);
  for (const double huge : {10.0, 1e300}) {
    hand.ball.linear = Vec3(0.0, huge, 0.0);
    hand.lever_rate = -huge;
    hand.direction_W = Vec3(huge, 0.0, 0.0);
    EXPECT_TRUE(cut_to_speed(hand, 0.25, 0.1));
    EXPECT_NEAR(hand.ball.linear.y(), 0.25, 1e-12);
    EXPECT_EQ(hand.lever_rate, -2.5);
    EXPECT_NEAR(hand.direction_W.x(), 1.0, 1e-12);
  }
  hand.direction_W = Vec3(0.0, 2.0, 0.0);
  hand.turning_W = Vec3(0.0, 10.0, 0.0);
  (void)cut_to_speed(hand, 0.25, 0.1);
  EXPECT_EQ(hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(hand.turning_W, Vec3(0.0, 5.0, 0.0)) << "the same screw";
  hand.lever_rate = 2.0;
  hand.scale = 2.0;  // the tool moves twice as far as the lever's scale says
  EXPECT_TRUE(cut_to_speed(hand, 0.25, 0.1));
  EXPECT_EQ(hand.lever_rate, 1.25);
  hand.scale = std::numeric_limits<double>::quiet_NaN();
  (void)cut_to_speed(hand, 0.25, 0.1);
  EXPECT_EQ(hand.scale, 1.0);
}

TEST(CutToSpeed, EachHandByTheScaleOfItsLever) {
  using namespace network;
  const Network levers =
      Plan()
          .add("left", TorqueArm())
          .add("across", Multiplex({.velocity_scale = 0.1, .force_scale = 0.1}))
          .add("left_grip", Relief({.compliant = {true, true, true, true, true, true}}), "tool")
          .add("right", TorqueArm({.hand = Hand::second}))
          .add("down", Multiplex({.velocity_scale = 0.5, .force_scale = 0.5, .hand = Hand::second}))
          .add("right_grip", Relief({.compliant = {true, true, true, true, true, true}}), "tool")
          .add("tool", Junction())
          .add("ground", Ground())
          .build(0.0025);
  const LeverScales scales = lever_scales(levers);
  EXPECT_EQ(scales.first, 0.1);
  EXPECT_EQ(scales.second, 0.5);
  Signals signals;
  signals.hand.lever_rate = signals.second.lever_rate = 1.0;
  EXPECT_TRUE(cut_to_speed(signals, 0.25, scales));
  EXPECT_EQ(signals.hand.lever_rate, 1.0);
  EXPECT_EQ(signals.second.lever_rate, 0.5);
  const Network without = Plan().add("hand", SixAxes()).add("ground", Ground()).build(0.0025);
  EXPECT_EQ(lever_scales(without).second, 1.0);
}

}  // namespace hand_speed_test
}  // namespace repel
