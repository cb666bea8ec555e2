// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/friction.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/families.hpp"

namespace repel::network {
namespace friction_test {

constexpr unsigned seed = 6;
constexpr double period = 0.0025;

/// What a joint is asked for: noise, jumps and drift, over several magnitudes [N m].
double any_torque(families::Rng& random, double dry_friction) {
  return families::uniform(random, -1.0, 1.0) * families::log_uniform(random, 1e-4, 10.0) *
         dry_friction;
}

FrictionCompensation any_compensation(families::Rng& random) {
  return {.share = families::uniform(random, 0.0, 0.95),
          .time = families::log_uniform(random, 1e-3, 1.0)};
}

TEST(FrictionCompensation, NeverExceedsItsShareOfTheFriction) {
  families::Rng random(seed);
  for (int i = 0; i < 1000; ++i) {
    FrictionCompensation compensation = any_compensation(random);
    const double friction = families::log_uniform(random, 1e-6, 100.0);
    const double T = 1.0 / families::log_uniform(random, 100.0, 4000.0);
    for (int k = 0; k < 100; ++k) {
      const double added = compensation(friction, any_torque(random, friction), T);
      ASSERT_LE(std::abs(added), compensation.share * friction) << "seed " << seed;
    }
  }
}

// The change of a tick is bounded, and that part of it which is due to the torque asked for is in
// proportion to that.
TEST(FrictionCompensation, IsLipschitzInTheTorqueAskedForAndInTime) {
  families::Rng random(seed);
  for (int i = 0; i < 1000; ++i) {
    FrictionCompensation compensation = any_compensation(random);
    const double friction = families::log_uniform(random, 1e-3, 100.0);
    const double T = 1.0 / families::log_uniform(random, 100.0, 4000.0);
    const double share = compensation.share;
    const double slope = share / (1.0 - share) * T / (compensation.time + T);
    const double most = (2.0 - share) * slope * friction;  // in a tick
    double last = 0.0;
    for (int k = 0; k < 100; ++k) {
      FrictionCompensation other = compensation;
      const double asked = any_torque(random, friction);
      const double otherwise = any_torque(random, friction);
      const double added = compensation(friction, asked, T);
      ASSERT_LE(std::abs(added - last), most * (1.0 + 1e-9)) << "seed " << seed;
      ASSERT_LE(std::abs(added - other(friction, otherwise, T)),
                slope * std::abs(asked - otherwise) + 1e-9 * friction)
          << "seed " << seed;
      last = added;
    }
  }
}

// Whatever the joint is asked for while it goes to and fro, friction and its compensation together
// take at least the rest of the friction all along the way.
TEST(FrictionCompensation, DissipatesWithTheFrictionAlongEveryClosedMotion) {
  families::Rng random(seed);
  for (int i = 0; i < 300; ++i) {
    FrictionCompensation compensation = any_compensation(random);
    const double friction = families::log_uniform(random, 1e-3, 50.0);
    double q = 0.0;     // [rad]
    double way = 0.0;   // [rad]
    double work = 0.0;  // [J] of compensation and friction on the joint
    const auto move = [&](double step) {
      const double added = compensation(friction, any_torque(random, friction), period);
      work += added * step - friction * std::abs(step);
      way += std::abs(step);
      q += step;
    };
    for (int k = 0; k < 200; ++k) move(families::uniform(random, -1e-3, 1e-3));
    move(-q);
    ASSERT_NEAR(q, 0.0, 1e-12);
    ASSERT_LE(work, -(1.0 - compensation.share) * friction * way * (1.0 - 1e-9)) << "seed " << seed;
  }
}

TEST(FrictionCompensation, LetsTheJointBreakAwayAtTheRestOfItsFriction) {
  constexpr double friction = 5.0;
  for (const double excess : {0.99, 1.01}) {
    FrictionCompensation compensation;
    const double asked = excess * (1.0 - compensation.share) * friction;
    double most = 0.0;
    for (int k = 0; k < 1000; ++k) {
      most = std::max(most, asked + compensation(friction, asked, period));
    }
    EXPECT_EQ(most > friction, excess > 1.0) << most;
  }
}

TEST(FrictionCompensation, GoesTheWayTheJointIsAskedToAndEndsWithIt) {
  FrictionCompensation there;
  FrictionCompensation back;
  EXPECT_EQ(there(5.0, 0.0, period), 0.0);
  for (int k = 0; k < 40; ++k) {
    const double added = there(5.0, 0.5, period);
    EXPECT_GT(added, 0.0);
    EXPECT_EQ(back(5.0, -0.5, period), -added);
  }
  // Five time constants.
  for (int k = 0; k < 100; ++k) (void)there(5.0, 0.0, period);
  EXPECT_LT(there(5.0, 0.0, period), 0.01 * there.share * 5.0);
}

// 63 % in the time constant, at every rate of the loop.
TEST(FrictionCompensation, TakesItsTimeAtEveryRate) {
  for (const double rate_hz : {100.0, 400.0, 1000.0, 4000.0}) {
    FrictionCompensation compensation;
    constexpr double friction = 2.0;
    const double asked = 0.5 * (1.0 - compensation.share) * friction;
    double added = 0.0;
    for (int k = 0; k < std::lround(compensation.time * rate_hz); ++k) {
      added = compensation(friction, asked, 1.0 / rate_hz);
    }
    EXPECT_NEAR(added / (0.5 * compensation.share * friction), 0.632, 0.04) << rate_hz;
  }
}

TEST(FrictionCompensation, JointWithoutFrictionIsLeftAlone) {
  FrictionCompensation compensation;
  EXPECT_EQ(compensation(0.0, 10.0, period), 0.0);
  EXPECT_EQ(compensation(-1.0, 10.0, period), 0.0);
  EXPECT_EQ(compensation(std::nan(""), 10.0, period), 0.0);
}

TEST(FrictionCompensation, StartsAnewAfterATorqueThatIsNotFinite) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  for (const double asked : {std::nan(""), endless, -endless}) {
    FrictionCompensation compensation;
    (void)compensation(5.0, 3.0, period);
    EXPECT_EQ(compensation(5.0, asked, period), 0.0);
    EXPECT_EQ(compensation(5.0, 1.0, period), FrictionCompensation()(5.0, 1.0, period));
  }
}

}  // namespace friction_test
}  // namespace repel::network
