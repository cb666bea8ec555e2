#include <repel/network/elements/friction.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace friction_test {

constexpr unsigned seed = 6;

TEST(FrictionCompensation, NeverExceedsItsShareOfTheFriction) {
  families::Rng random(seed);
  for (int i = 0; i < 10000; ++i) {
    const FrictionCompensation compensation{.share = families::uniform(random, 0.0, 1.0)};
    const double friction = families::log_uniform(random, 1e-6, 100.0);
    const double v = families::uniform(random, -1.0, 1.0) * families::log_uniform(random, 1e-6, 10);
    const double asked = families::uniform(random, -200.0, 200.0);
    const double added = compensation(friction, v, asked);
    ASSERT_LE(std::abs(added), compensation.share * friction) << "seed " << seed;
  }
}

// The friction that remains always brakes: compensation never drives a joint.
TEST(FrictionCompensation, LeavesFrictionThatBrakes) {
  families::Rng random(seed);
  const FrictionCompensation compensation;
  for (int i = 0; i < 10000; ++i) {
    const double friction = families::log_uniform(random, 1e-3, 50.0);
    const double v = families::uniform(random, -2.0, 2.0);
    const double left = -friction * (v > 0.0 ? 1.0 : -1.0) +
                        compensation(friction, v, families::uniform(random, -50.0, 50.0));
    ASSERT_LT(left * v, 0.0) << "seed " << seed;
  }
}

TEST(FrictionCompensation, GoesTheWayTheJointMovesOrIsAskedTo) {
  const FrictionCompensation compensation;
  EXPECT_GT(compensation(5.0, 0.1, 0.0), 0.0);
  EXPECT_LT(compensation(5.0, -0.1, 0.0), 0.0);
  EXPECT_GT(compensation(5.0, 0.0, 1.0), 0.0);
  EXPECT_LT(compensation(5.0, 0.0, -1.0), 0.0);
  EXPECT_EQ(compensation(5.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(compensation(5.0, 0.3, 2.0), -compensation(5.0, -0.3, -2.0));
}

TEST(FrictionCompensation, JointWithoutFrictionIsLeftAlone) {
  const FrictionCompensation compensation;
  EXPECT_EQ(compensation(0.0, 1.0, 10.0), 0.0);
  EXPECT_EQ(compensation(-1.0, 1.0, 10.0), 0.0);
  EXPECT_EQ(compensation(std::nan(""), 1.0, 10.0), 0.0);
}

}  // namespace friction_test
}  // namespace repel::network
