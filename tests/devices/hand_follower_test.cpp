// SPDX-License-Identifier: BSD-3-Clause
#include <repel/devices/hand_follower.hpp>

#include <gtest/gtest.h>

#include <support/families.hpp>

namespace repel::devices {
namespace hand_follower_test {

constexpr double period = 0.0025;

Measured at(const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Measured m;
  m.operating_state = OperatingState::enabled;
  m.position_W = position;
  m.has_position = true;
  m.measured_cv.linear = velocity;
  return m;
}

TEST(HandFollower, PassesTheRatesOfADeviceWithoutAPose) {
  HandFollower follower;
  Measured m;
  m.operating_state = OperatingState::enabled;
  m.measured_cv = {Vec3(0.1, 9.0, 0.0), Vec3(0.0, 99.0, 0.2)};
  EXPECT_EQ(follower.step(m, period).linear, m.measured_cv.linear);
  EXPECT_EQ(follower.step(m, period).angular, m.measured_cv.angular);
}

// The readings come as they like, and their velocities are wrong.
TEST(HandFollower, TheSumOfItsRatesNeverDriftsFromThePosition) {
  constexpr unsigned seed = 5;
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "hand", 0));
  HandFollower follower;
  const Vec3 begin(0.1, -0.2, 0.3);
  Vec3 position = begin, sum = begin;
  Measured m = at(begin);
  for (int tick = 0; tick < 40000; ++tick) {
    const double t = period * tick;
    position = begin + 0.05 * Vec3(std::sin(2 * t), std::sin(3 * t), 1.0 - std::cos(t));
    const Vec3 velocity = 0.05 * Vec3(2 * std::cos(2 * t), 3 * std::cos(3 * t), std::sin(t));
    if (rng() % 3 != 0) m = at(position, 0.8 * velocity + Vec3(0.01, 0, 0));
    sum += period * follower.step(m, period).linear;
    ASSERT_LT((sum - position).norm(), 0.003) << tick;
  }
}

TEST(HandFollower, WithOnePeriodItIsTheDifferenceOfPositions) {
  HandFollower follower({.time = period});
  EXPECT_EQ(follower.step(at(Vec3(0.1, 0, 0)), period).linear, Vec3::Zero());
  EXPECT_NEAR(follower.step(at(Vec3(0.101, 0, 0)), period).linear.x(), 0.4, 1e-9);
  EXPECT_NEAR(follower.step(at(Vec3(0.101, 0, 0)), period).linear.x(), 0.0, 1e-9);
}

TEST(HandFollower, AClutchMovesTheHandWithoutTheTool) {
  HandFollower follower;
  EXPECT_EQ(follower.step(at(Vec3::Zero()), period).linear, Vec3::Zero());
  Measured away = at(Vec3(0.2, 0, 0));
  away.operating_state = OperatingState::paused;
  EXPECT_EQ(follower.step(away, period).linear, Vec3::Zero());
  EXPECT_EQ(follower.step(at(Vec3(0.2, 0, 0)), period).linear, Vec3::Zero());
  EXPECT_GT(follower.step(at(Vec3(0.201, 0, 0)), period).linear.x(), 0.0);
}

TEST(HandFollower, WhatItsLimitWithholdsIsGivenUp) {
  HandFollower follower({.most_rate = 1.0, .most_angular_rate = 2.0});
  Measured m = at(Vec3::Zero());
  m.has_orientation = true;
  (void)follower.step(m, period);
  m.position_W = Vec3(0, 0.3, 0);
  m.R_WH = Eigen::AngleAxisd(1.0, Vec3::UnitX());
  const Twist rates = follower.step(m, period);
  EXPECT_NEAR(rates.linear.y(), 1.0, 1e-12);
  EXPECT_NEAR(rates.angular.x(), 2.0, 1e-12);
  EXPECT_EQ(follower.step(m, period).linear, Vec3::Zero());
  EXPECT_EQ(follower.step(m, period).angular, Vec3::Zero());
}

TEST(HandFollower, TurnsWithTheHandWhicheverSignTheQuaternionHas) {
  constexpr unsigned seed = 6;
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "hand", 0));
  HandFollower follower;
  Measured m = at(Vec3::Zero());
  m.has_orientation = true;
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  Eigen::Quaterniond sum = Eigen::Quaterniond::Identity();
  for (int tick = 0; tick < 4000; ++tick) {
    const double angle = 4.0 * std::sin(period * tick);  // more than half a turn
    m.R_WH = Eigen::AngleAxisd(angle, axis);
    if (rng() % 2 == 0) m.R_WH.coeffs() *= -1.0;
    const Vec3 rate = follower.step(m, period).angular;
    if (rate.norm() > 0.0) {
      sum = Eigen::AngleAxisd(period * rate.norm(), rate.normalized()) * sum;
    }
    ASSERT_LT(sum.angularDistance(m.R_WH), 0.05) << tick;
  }
}

TEST(HandFollower, AGripThatComesLaterTurnsNothing) {
  HandFollower follower;
  (void)follower.step(at(Vec3::Zero()), period);
  Measured m = at(Vec3::Zero());
  m.has_orientation = true;
  m.R_WH = Eigen::AngleAxisd(1.0, Vec3::UnitX());
  EXPECT_EQ(follower.step(m, period).angular, Vec3::Zero());
}

TEST(HandFollower, RefusesNumbersOutOfRange) {
  EXPECT_THROW(HandFollower({.time = 0.0}), SetupError);
  EXPECT_THROW(HandFollower({.most_rate = -1.0}), SetupError);
  EXPECT_THROW(HandFollower({.most_angular_rate = 1e4}), SetupError);
}

}  // namespace hand_follower_test
}  // namespace repel::devices
