// SPDX-License-Identifier: BSD-3-Clause
// Friction and stops at the joints of the simulated arm.
#include <gtest/gtest.h>

#include "arms.hpp"

namespace repel::bullet::test {
namespace arm_joint_test {

TEST(BulletArmJoint, ViscousFrictionOpposesMotionInProportion) {
  ArmModel model = turntable(0.5);
  model.links[0].viscous_friction = 0.8;
  Arm arm(model, {.substeps = 1});
  EXPECT_NEAR(accelerations(arm, {0.0}, {2.0}, {0.0})[0], -0.8 * 2.0 / 0.5, 1e-4);
  EXPECT_NEAR(accelerations(arm, {0.0}, {-2.0}, {0.0})[0], 0.8 * 2.0 / 0.5, 1e-4);
  arm.reset(std::vector{0.0});
  arm.set_torques(std::vector{4.0});
  for (int tick = 0; tick < 8000; ++tick) arm.step(1.0 / 400);
  EXPECT_NEAR(velocities(arm)[0], 4.0 / 0.8, 1e-9);
}

TEST(BulletArmJoint, FrictionOfAnyStrengthIsStable) {
  ArmModel model = turntable(1e-4);
  model.links[0].viscous_friction = 1e6;
  model.links[0].coulomb_friction = 1e6;
  Arm arm(model);
  arm.reset(std::vector{0.0}, std::vector{10.0});
  arm.set_torques(std::vector{2e6});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  EXPECT_NEAR(velocities(arm)[0], 1.0, 1e-6);
}

TEST(BulletArmJoint, CoulombFrictionOpposesMotionWithItsFullMagnitudeAtAnySpeed) {
  ArmModel model = turntable(0.5);
  model.links[0].coulomb_friction = 3.0;
  Arm arm(model, {.substeps = 1});
  for (const double speed : {1e-3, 1.0, 50.0}) {
    EXPECT_NEAR(accelerations(arm, {0.0}, {speed}, {0.0})[0], -3.0 / 0.5, 1e-7);
    EXPECT_NEAR(accelerations(arm, {0.0}, {-speed}, {0.0})[0], 3.0 / 0.5, 1e-7);
  }
  EXPECT_NEAR(accelerations(arm, {0.0}, {0.0}, {5.0})[0], (5.0 - 3.0) / 0.5, 1e-9);
}

TEST(BulletArmJoint, ATorqueBelowTheCoulombFrictionMovesNothingAtAll) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) link.coulomb_friction = 100.0;
  Arm arm(model);
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  arm.reset(q);
  for (int tick = 0; tick < 4000; ++tick) arm.step(1.0 / 400);
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_NEAR(positions(arm)[i], q[i], 1e-12) << i;
  }
}

TEST(BulletArmJoint, CoulombFrictionStopsAMovingJointWhereTheWorkIsDone) {
  ArmModel model = turntable(0.5);
  model.links[0].coulomb_friction = 3.0;
  Arm arm(model);
  arm.reset(std::vector{0.0}, std::vector{2.0});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  EXPECT_NEAR(positions(arm)[0], 0.5 * 0.5 * 2.0 * 2.0 / 3.0, 1e-3);
  EXPECT_NEAR(velocities(arm)[0], 0.0, 1e-15);
}

TEST(BulletArmJoint, AStopTakesEnergyAndLetsGo) {
  ArmModel model = turntable(0.5);
  model.links[0].lower = -0.5;
  model.links[0].upper = 0.5;
  Arm arm(model);
  arm.reset(std::vector{0.0}, std::vector{8.0});
  double deepest = 0.0;
  for (int tick = 0; tick < 400; ++tick) {
    arm.step(1.0 / 400);
    deepest = std::max(deepest, positions(arm)[0] - 0.5);
    EXPECT_LE(std::abs(velocities(arm)[0]), 8.0);
  }
  EXPECT_LT(deepest, 0.02);
  EXPECT_LT(std::abs(velocities(arm)[0]), 4.0);
  arm.reset(std::vector{0.5});
  arm.set_torques(std::vector{-0.01});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  EXPECT_NEAR(positions(arm)[0], 0.5 - 0.5 * 0.01 / 0.5, 1e-4);  // no restoring force
}

TEST(BulletArmJoint, TheStopOfOneJointStandsWhileTheOthersSwing) {
  Arm arm(puma560());
  const ArmModel model = puma560();
  for (int tick = 0; tick < 4000; ++tick) {
    arm.step(1.0 / 400);
    const std::vector<double> q = positions(arm);
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_GT(q[i], model.links[i].lower - 0.02) << i;
      ASSERT_LT(q[i], model.links[i].upper + 0.02) << i;
    }
  }
}

}  // namespace arm_joint_test
}  // namespace repel::bullet::test
