// SPDX-License-Identifier: BSD-3-Clause
// The ODE arm: its mechanics, its joints and its other properties. What every engine has is in
// tests/engines.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <repel/base/setup_error.hpp>
#include <repel/ode/arm.hpp>

#include "simulated/arms.hpp"

namespace repel::ode {
namespace arm_test {

using namespace simulated;

constexpr double period = 1.0 / 400;

TEST(OdeArm, PendulumSwingsWithThePeriodOfTheEllipticIntegralAndKeepsItsEnergy) {
  const ArmModel model = pendulum();
  double larger = 1.0;
  double smaller = std::cos(0.5);
  for (int i = 0; i < 6; ++i) {
    const double mean = (larger + smaller) / 2;
    smaller = std::sqrt(larger * smaller);
    larger = mean;
  }
  const double swing = 2 * pi / (std::sqrt(2.0 * 9.81 * 0.5 / 0.53) * larger);
  Arm arm(model, {.substeps = 16});
  arm.reset(std::vector{1.0});
  const double before = energy(model, arm);
  for (int tick = 0; tick < 8000; ++tick) arm.step(20 * swing / 8000);
  EXPECT_NEAR(positions(arm)[0], 1.0, 1e-3);
  EXPECT_NEAR(energy(model, arm), before, 1e-2);
  EXPECT_LT(arm.parted(), 1e-6);
}

TEST(OdeArm, AnswersTorquesAsBothMassesAndRotorsSay) {
  ArmModel model = turntable(0.5);
  model.links[0].rotor_inertia = 1.5;
  Arm arm(model);
  EXPECT_NEAR(accelerations(arm, {0.0}, {0.0}, {4.0})[0], 2.0, 1e-6);
}

TEST(OdeArm, TurnsAsFarAsItsJointsAllow) {
  ArmModel model = turntable(0.5);
  Arm arm(model);
  arm.reset(std::vector{0.0}, std::vector{2.0});
  for (int tick = 0; tick < 4000; ++tick) arm.step(period);
  EXPECT_NEAR(positions(arm)[0], 20.0, 1e-9) << "three turns are not none";
  arm.reset(std::vector{-9.0});
  arm.step(period);
  EXPECT_NEAR(positions(arm)[0], -9.0, 1e-9);
}

TEST(OdeArm, APrismaticJointFallsFreely) {
  ArmModel model = turntable(0.5);
  model.links[0].type = JointType::prismatic;
  Arm arm(model);
  for (int tick = 0; tick < 400; ++tick) arm.step(period);
  EXPECT_NEAR(velocities(arm)[0], -9.81, 1e-6);
  EXPECT_NEAR(positions(arm)[0], -0.5 * 9.81, 0.01);
}

TEST(OdeArm, FrictionHoldsBelowItsLimitAndOpposesBeyondIt) {
  ArmModel model = turntable(0.5);
  model.links[0].coulomb_friction = 3.0;
  model.links[0].viscous_friction = 2.0;
  Arm arm(model);
  arm.set_torques(std::vector{2.9});
  for (int tick = 0; tick < 400; ++tick) arm.step(period);
  EXPECT_NEAR(positions(arm)[0], 0.0, 1e-9);
  arm.set_torques(std::vector{4.0});
  for (int tick = 0; tick < 2000; ++tick) arm.step(period);
  EXPECT_NEAR(velocities(arm)[0], (4.0 - 3.0) / 2.0, 1e-6);
}

TEST(OdeArm, TheLinksOfAPumaStayTogether) {
  Arm arm(heavy_puma());
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> effort(-20.0, 20.0);
  for (int tick = 0; tick < 400; ++tick) {
    std::vector<double> torques(6);
    for (double& torque : torques) torque = effort(generator);
    arm.set_torques(torques);
    arm.step(period);
  }
  EXPECT_LT(arm.parted(), 1e-3);
}

TEST(OdeArm, LivesThroughTorquesBeyondAllReason) {
  Arm arm(heavy_puma());
  arm.set_torques(std::vector(6, 1e9));
  for (int tick = 0; tick < 100; ++tick) arm.step(0.1);
  for (const double q : positions(arm)) EXPECT_TRUE(std::isfinite(q));
  arm.reset(std::vector(6, 0.0));
  arm.step(period);
  EXPECT_LT(std::abs(positions(arm)[5]), 0.1);
}

TEST(OdeArm, SetUpRefusesWhatItCannotMove) {
  ArmModel model = heavy_puma();
  model.links[3].mass = 0.0;
  EXPECT_THROW(Arm{model}, SetupError);
}

}  // namespace arm_test
}  // namespace repel::ode
