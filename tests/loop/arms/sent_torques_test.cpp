// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/sent_torques.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace sent_torques_test {

SentTorques sent(double delay, const std::vector<double>& torques) {
  SentTorques ring(1, delay);
  for (const double torque : torques) {
    SentTorques::Vector net(1);
    net(0) = torque;
    ring.add(net);
  }
  return ring;
}

TEST(SentTorques, WithoutDelayTheLastOneActed) {
  const SentTorques ring = sent(0.0, {3.0, -2.0});
  EXPECT_EQ(ring.acted(0), -2.0);
  EXPECT_EQ(ring.surely(0), -2.0);
  EXPECT_EQ(ring.at_most(0), 2.0);
}

TEST(SentTorques, ALateDriveMayBeOneThatIsNot) {
  const SentTorques ring = sent(2.0, {9.0, 5.0, 3.0, 4.0});
  EXPECT_EQ(ring.acted(0), 5.0);
  EXPECT_EQ(ring.surely(0), 3.0);
  EXPECT_EQ(ring.at_most(0), 5.0);
  EXPECT_EQ(sent(1.0, {5.0, -3.0}).surely(0), 0.0) << "which of both acted is not known";
}

TEST(SentTorques, APartOfATickMixesTwo) {
  EXPECT_DOUBLE_EQ(sent(0.25, {4.0, 8.0}).acted(0), 7.0);
}

}  // namespace sent_torques_test
}  // namespace repel
