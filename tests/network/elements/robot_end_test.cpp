// SPDX-License-Identifier: BSD-3-Clause
// Gains that are chosen for an arm.
#include <repel/network/elements/robot_end.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/network/modules/relief.hpp>

namespace repel::network {
namespace robot_end_test {

RobotEnd light_arm() {
  RobotEnd robot{.mass = 2.0, .inertia = 0.01};
  robot.joints.setConstant(2, 0.5);
  robot.response = 0.004;
  robot.wall_ticks = 2.5;
  return robot;
}

TEST(RobotEnd, GainsLeftToTheArmAreCriticallyDampedAndAsFastAsItAnswers) {
  const Gains gains = suited({automatic, automatic}, 2.0, 0.004, {});
  EXPECT_DOUBLE_EQ(std::sqrt(gains.stiffness / 2.0), 1.0 / 0.008);          // [rad/s]
  EXPECT_DOUBLE_EQ(gains.damping, 2.0 * std::sqrt(gains.stiffness * 2.0));  // ratio 1
  const Gains own = suited({100.0, automatic}, 2.0, 0.004, {});
  EXPECT_EQ(own.stiffness, 100.0);
  EXPECT_DOUBLE_EQ(own.damping, 2.0 * std::sqrt(200.0));
  EXPECT_EQ(suited({automatic, 7.0}, 2.0, 0.004, {}).damping, 7.0);
  EXPECT_EQ(suited({automatic, automatic}, 2.0, 0.004, {1e6, 1e5}).stiffness, 1e6);
  EXPECT_EQ(suited({automatic, automatic}, 2.0, 0.004, {1e6, 1e5}).damping, 1e5);
}

TEST(RobotEnd, WithoutAKnownMassTheyAreTheUsualOnes) {
  const Gains gains = suited({automatic, automatic}, 0.0, 0.004, {3.0, 4.0});
  EXPECT_EQ(gains.stiffness, 3.0);
  EXPECT_EQ(gains.damping, 4.0);
}

TEST(RobotEnd, ModulesTakeThem) {
  Kbb2 coupling(Kbb2Options{.stiffness = automatic, .damping = automatic, .angular_damping = 1.0});
  coupling.suit(light_arm());
  // 60 N at 0.25 m/s: less than the 500 N s/m that would suit 2 kg.
  EXPECT_DOUBLE_EQ(coupling.options().damping, 240.0);
  EXPECT_DOUBLE_EQ(coupling.options().stiffness, 240.0 * 240.0 / 8.0);
  EXPECT_EQ(coupling.options().angular_stiffness, 60.0);
  EXPECT_EQ(coupling.options().angular_damping, 1.0);

  Limits limits({.stiffness = automatic, .damping = automatic}, {{-1.0, 1.0}, {-1.0, 1.0}});
  limits.suit(light_arm());
  limits.prepare(0.001);
  EXPECT_DOUBLE_EQ(limits.law(1).stiffness, 0.25 * 0.5 / 16e-6);
  EXPECT_DOUBLE_EQ(limits.law(1).damping, 0.5 / 0.004);

  EXPECT_NO_THROW(Relief({.damping = automatic}));
  EXPECT_THROW(Relief({.stiffness = automatic}), SetupError);
  EXPECT_THROW(Kbb2({.stiffness = -2.0}), SetupError);
}

// They were refused where the drive was late: the damping was raised for a drive that is not.
TEST(RobotEnd, DampingOfLimitsIsRaisedForALateDrive) {
  Limits limits({.stiffness = 2000.0, .damping = 2.0}, {{-1.0, 1.0}});
  limits.suit(light_arm());
  limits.prepare(0.0025);
  EXPECT_DOUBLE_EQ(limits.law(0).damping, 2.5 * 0.0025 * 2000.0);
}

}  // namespace robot_end_test
}  // namespace repel::network
