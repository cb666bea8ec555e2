// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/spaceball.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace spaceball_test {

using test::period;

constexpr unsigned seed = 66;
const SpaceballOptions unfiltered{.time_constant = 0.0};

/// The twist that a ball generates from raw rates.
Twist pressed(Spaceball& ball, const Twist& raw) {
  Signals signals;
  signals.hand.ball = raw;
  ball.read(signals);
  return ball.twist();
}
Spaceball ready(const SpaceballOptions& options, double T = period) {
  Spaceball ball(options);
  ball.prepare(T);
  return ball;
}

TEST(Spaceball, AddsItsRatesUnderTheSameEffortAndAccountsForThem) {
  for (const Side root : {Side::left, Side::right}) {
    SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
    Rng rng(seed);
    DrawnSignals drawn(rng, 0);
    DrawnEnds ends(rng, 6, 20.0);
    Cell cell(Spaceball(), root);
    for (int tick = 0; tick < families::draws(1000000) / 2; ++tick) {
      const auto behind = tick % 3 == 0 ? ends.slack() : ends.moved(0.5);
      ASSERT_TRUE(cell.run(drawn.next(), behind, ends.definite()));
      ASSERT_EQ(cell.at_root.effort, cell.at_leaf.effort);
      const auto& left = root == Side::right ? cell.at_leaf : cell.at_root;
      const auto& right = root == Side::right ? cell.at_root : cell.at_leaf;
      const Vector ball = to_vec(cell.module.twist());
      ASSERT_LE((right.flow - left.flow - ball).norm(), 1e-12 * (1.0 + right.flow.norm()));
      ASSERT_LE(cell.error_behind(behind), 1e-9);
    }
    EXPECT_GT(cell.ledger.passed, 1.0);
    EXPECT_GT(std::abs(cell.ledger.supplied), 1e-3 * cell.ledger.passed);
    EXPECT_LE(std::abs(cell.ledger.energy), 1e-9 * cell.ledger.passed);
    EXPECT_LE(cell.ledger.deficit(), 1e-9);
  }
}

// The ball moves a tool on its right against a damper there.
TEST(Spaceball, SuppliesThePowerThatItsMotionTakes) {
  Equivalent<any_size> damper;
  damper.set_impedance(10.0 * test::Matrix::Identity(6, 6), Vector::Zero(6));
  Equivalent<any_size> ground;
  ground.set_admittance(test::Matrix::Zero(6, 6), Vector::Zero(6));
  Signals signals;
  signals.hand.ball.linear = Vec3(0.102, 0.0, 0.0);
  for (const Side root : {Side::left, Side::right}) {
    const bool right = root == Side::right;
    Cell cell(Spaceball(unfiltered), root);
    ASSERT_TRUE(cell.run(signals, right ? ground : damper, right ? damper : ground));
    EXPECT_NEAR(cell.module.supplied(), 10.0 * 0.1 * 0.1, 1e-12);
    EXPECT_NEAR((right ? cell.at_root : cell.at_leaf).flow(0), 0.1, 1e-12);
    // Its ports alone give energy; that it is called passive holds with what it supplies.
    EXPECT_TRUE(Spaceball::traits.passive);
    EXPECT_LT(cell.ledger.energy - cell.ledger.supplied, 0.0);
    EXPECT_NEAR(cell.ledger.energy, 0.0, 1e-12);
  }
}

TEST(Spaceball, RatesInTheDeadBandAreRest) {
  Rng rng(seed);
  Spaceball ball = ready(unfiltered);
  for (int i = 0; i < 1000; ++i) {
    const Twist V =
        pressed(ball, {0.0019999 * families::direction(rng),
                       families::uniform(rng, 0.0, 0.00999) * families::direction(rng)});
    EXPECT_EQ(V.linear, Vec3::Zero()) << "seed " << seed;
    EXPECT_EQ(V.angular, Vec3::Zero()) << "seed " << seed;
  }
}

TEST(Spaceball, DeadBandIsLeftWithoutAStep) {
  Spaceball ball = ready(unfiltered);
  EXPECT_NEAR(pressed(ball, {{0.002 + 1e-9, 0, 0}, {}}).linear.x(), 1e-9, 1e-15);
  EXPECT_NEAR(pressed(ball, {{}, {0, 0.01 + 1e-9, 0}}).angular.y(), 1e-9, 1e-15);
}

TEST(Spaceball, SaturationAndDeadBandKeepTheDirection) {
  Rng rng(seed);
  Spaceball ball = ready(unfiltered);
  int saturated = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = families::direction(rng);
    const Vec3 m = families::direction(rng);
    const Twist V = pressed(
        ball, {families::uniform(rng, 0.01, 1.0) * n, families::uniform(rng, 0.05, 5.0) * m});
    EXPECT_LE(V.linear.norm(), 0.25 * (1.0 + 1e-12)) << "seed " << seed;
    EXPECT_LE(V.angular.norm(), 1.0 + 1e-12) << "seed " << seed;
    EXPECT_LE(V.linear.cross(n).norm(), 1e-15) << "seed " << seed;
    EXPECT_LE(V.angular.cross(m).norm(), 1e-14) << "seed " << seed;
    EXPECT_GT(V.linear.dot(n), 0.0) << "seed " << seed;
    const bool full = V.linear.norm() > 0.25 - 1e-9 || V.angular.norm() > 1.0 - 1e-9;
    EXPECT_EQ(ball.saturated(), full) << "seed " << seed;
    saturated += full ? 1 : 0;
  }
  EXPECT_GT(saturated, 300);
  EXPECT_LT(saturated, 1000);
}

TEST(Spaceball, LowPassReachesAStepInItsTimeConstantAtAnyRate) {
  for (const double T : {0.001, 0.0025, 0.0001}) {
    Spaceball ball = ready({.dead_band = 0.0, .saturation = 1.0, .time_constant = 0.1}, T);
    double last = 0.0;
    double x = 0.0;
    for (int tick = 0; tick < static_cast<int>(0.1 / T + 0.5); ++tick) {
      x = pressed(ball, {{0.1, 0, 0}, {}}).linear.x();
      ASSERT_GT(x, last);
      ASSERT_LT(x, 0.1);  // no overshoot
      last = x;
    }
    EXPECT_NEAR(x, 0.1 * (1.0 - std::exp(-1.0)), 0.1 * 0.01);
  }
}

TEST(Spaceball, ForgetsTheMotionAtRest) {
  Spaceball ball = ready({});
  for (int i = 0; i < 100; ++i) (void)pressed(ball, {{0.1, 0, 0}, {0, 1, 0}});
  EXPECT_GT(ball.twist().linear.x(), 0.05);
  Signals rest;
  rest.at_rest = true;
  rest.hand.ball.linear.x() = 0.1;
  ball.read(rest);
  EXPECT_EQ(ball.twist().linear, Vec3::Zero());
  EXPECT_EQ(ball.twist().angular, Vec3::Zero());
}

TEST(Spaceball, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Spaceball({.dead_band = -1.0}), SetupError);
  EXPECT_THROW(Spaceball({.saturation = 11.0}), SetupError);
  EXPECT_THROW(Spaceball({.angular_dead_band = std::nan("")}), SetupError);
  EXPECT_THROW(Spaceball({.angular_saturation = -0.1}), SetupError);
  EXPECT_THROW(Spaceball({.time_constant = 101.0}), SetupError);
}

}  // namespace spaceball_test
}  // namespace repel::network
