#include <repel/network/spaceball.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr double period = 0.0025;
constexpr unsigned seed = 66;
const SpaceballOptions unfiltered{.time_constant = 0.0};

TEST(Spaceball, RatesInTheDeadBandAreRest) {
  families::Rng random(seed);
  Spaceball ball(unfiltered);
  for (int i = 0; i < 1000; ++i) {
    const Twist V =
        ball.step({0.0019999 * families::direction(random),
                   families::uniform(random, 0.0, 0.00999) * families::direction(random)},
                  period);
    EXPECT_EQ(V.linear, Vec3::Zero()) << "seed " << seed;
    EXPECT_EQ(V.angular, Vec3::Zero()) << "seed " << seed;
  }
}

TEST(Spaceball, DeadBandIsLeftWithoutAStep) {
  Spaceball ball(unfiltered);
  EXPECT_NEAR(ball.step({{0.002 + 1e-9, 0, 0}, {}}, period).linear.x(), 1e-9, 1e-15);
}

TEST(Spaceball, SaturationAndDeadBandKeepTheDirection) {
  families::Rng random(seed);
  Spaceball ball(unfiltered);
  int saturated = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = families::direction(random);
    const Vec3 m = families::direction(random);
    const Twist V = ball.step(
        {families::uniform(random, 0.01, 1.0) * n, families::uniform(random, 0.05, 5.0) * m},
        period);
    EXPECT_LE(V.linear.norm(), 0.25 * (1.0 + 1e-12)) << "seed " << seed;
    EXPECT_LE(V.angular.norm(), 1.0 + 1e-12) << "seed " << seed;
    EXPECT_LE(V.linear.cross(n).norm(), 1e-15) << "seed " << seed;
    EXPECT_LE(V.angular.cross(m).norm(), 1e-14) << "seed " << seed;
    EXPECT_GT(V.linear.dot(n), 0.0) << "seed " << seed;
    saturated += V.linear.norm() > 0.2499 ? 1 : 0;
  }
  EXPECT_GT(saturated, 300);
  EXPECT_LT(saturated, 1000);
}

TEST(Spaceball, LowPassReachesAStepInItsTimeConstantAtAnyRate) {
  for (const double T : {0.001, 0.0025, 0.0001}) {
    Spaceball ball(SpaceballOptions{.dead_band = 0.0, .saturation = 1.0, .time_constant = 0.1});
    double last = 0.0;
    double x = 0.0;
    for (int tick = 0; tick < static_cast<int>(0.1 / T + 0.5); ++tick) {
      x = ball.step({{0.1, 0, 0}, {}}, T).linear.x();
      ASSERT_GT(x, last);
      ASSERT_LT(x, 0.1);  // no overshoot
      last = x;
    }
    EXPECT_NEAR(x, 0.1 * (1.0 - std::exp(-1.0)), 0.1 * 0.01);
  }
}

TEST(Spaceball, ResetForgetsTheMotion) {
  Spaceball ball{SpaceballOptions{}};
  for (int i = 0; i < 100; ++i) (void)ball.step({{0.1, 0, 0}, {0, 1, 0}}, period);
  ball.reset();
  EXPECT_EQ(ball.step({}, period).linear, Vec3::Zero());
  EXPECT_EQ(ball.step({}, period).angular, Vec3::Zero());
}

}  // namespace
}  // namespace repel::network
