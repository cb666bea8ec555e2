// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/signals.hpp>

#include <gtest/gtest.h>

#include <set>
#include <string>

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

// What is not among the fields is neither recorded nor sent: of a second hand that was so for five
// numbers of nine.
TEST(Signals, EveryNumberOfAHandIsAmongItsFields) {
  HandInput hand;
  const HandInput none;
  std::set<std::string> names;
  std::size_t bytes = 0;
  std::size_t padding = 0;
  for_each_field(
      [&](const HandField& field, auto& x, const auto& other) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_STRNE(field.what, "") << field.name;
        EXPECT_GE(reinterpret_cast<const char*>(&x), reinterpret_cast<const char*>(&hand));
        EXPECT_EQ(x, other);
        bytes += sizeof x;
        padding += (8 - sizeof x % 8) % 8;
      },
      hand, none);
  EXPECT_EQ(bytes + padding, sizeof(HandInput));
}

TEST(Signals, HandThatRestsKeepsWhatItChose) {
  HandInput hand;
  hand.ball.linear.x() = hand.lever_rate = 1.0;
  hand.direction_W = Vec3(0, 1, 0);
  hand.scale = 2.0;
  hand.rest();
  EXPECT_EQ(hand.ball.linear, Vec3::Zero());
  EXPECT_EQ(hand.lever_rate, 0.0);
  EXPECT_EQ(hand.direction_W, Vec3(0, 1, 0));
  EXPECT_EQ(hand.scale, 2.0);
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
