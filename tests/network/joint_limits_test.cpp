#include <repel/network/joint_limits.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr unsigned seed = 12;

TEST(JointLimits, FreeBetweenTheRangesWhateverTheRate) {
  const JointLimits limits;
  for (const double v : {-10.0, 0.0, 10.0}) {
    EXPECT_EQ(limits(0.0, v, -1.0, 1.0), 0.0);
    EXPECT_EQ(limits(0.9, v, -1.0, 1.0), 0.0);
    EXPECT_EQ(limits(-0.9, v, -1.0, 1.0), 0.0);
  }
}

TEST(JointLimits, OnlyEverPushInward) {
  families::Rng random(seed);
  int pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    const JointLimits limits{.range = families::uniform(random, 0.01, 0.3)};
    const double q = families::uniform(random, -1.5, 1.5);
    const double torque = limits(q, families::uniform(random, -5.0, 5.0), -1.0, 1.0);
    if (q > 0.0) {
      ASSERT_LE(torque, 0.0) << "seed " << seed;
    }
    if (q < 0.0) {
      ASSERT_GE(torque, 0.0) << "seed " << seed;
    }
    pushed += torque != 0.0 ? 1 : 0;
  }
  EXPECT_GT(pushed, 5000);
}

TEST(JointLimits, BeginAtZeroAndRiseWithTheSpring) {
  const JointLimits limits{.range = 0.1, .stiffness = 200.0, .damping = 10.0};
  EXPECT_NEAR(limits(0.9 + 1e-9, 0.0, -1.0, 1.0), 0.0, 1e-6);
  EXPECT_NEAR(limits(0.95, 0.0, -1.0, 1.0), -10.0, 1e-9);
  EXPECT_NEAR(limits(-1.0, 0.0, -1.0, 1.0), 20.0, 1e-9);
  EXPECT_NEAR(limits(1.05, 0.0, -1.0, 1.0), -30.0, 1e-9);
  EXPECT_NEAR(limits(0.95, 0.5, -1.0, 1.0), -15.0, 1e-9);  // on the way out: damped
  EXPECT_NEAR(limits(0.95, -2.0, -1.0, 1.0), 0.0, 1e-9);   // on the way back: never held
}

}  // namespace
}  // namespace repel::network
