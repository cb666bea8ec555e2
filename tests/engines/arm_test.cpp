// SPDX-License-Identifier: BSD-3-Clause
// What every engine says alike of balance, stops, determinism, bad input and set-up.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include <repel/base/setup_error.hpp>

#include "engines/arms.hpp"

namespace repel::simulated {
namespace arm_test {

template <class Engine>
struct EngineArm : testing::Test {};
TYPED_TEST_SUITE(EngineArm, EveryEngine);

TYPED_TEST(EngineArm, TorquesThatBalanceGravityHoldItStill) {
  const ArmModel model = TypeParam::puma();
  typename TypeParam::Arm arm(model);
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  arm.reset(q);
  arm.set_torques(holding_torques(model, q));
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_NEAR(positions(arm)[i], q[i], TypeParam::creep) << i;
  }
  arm.set_torques(std::vector(6, 0.0));
  arm.step(0.1);
  EXPECT_GT(std::abs(positions(arm)[1] - q[1]), 1e-3);  // so the torques held it
}

TYPED_TEST(EngineArm, AStopHoldsAgainstALoadWithinLoadOverStiffnessAndLetsGo) {
  ArmModel model = turntable(0.5);
  model.links[0].lower = -0.7;
  model.links[0].upper = 0.4;
  for (const double stiffness : {2e4, 1e5}) {
    typename TypeParam::Arm arm(model, {.substeps = 4, .stop_stiffness = stiffness});
    for (const double torque : {150.0, -150.0, 20.0}) {
      arm.set_torques(std::vector{torque});
      for (int tick = 0; tick < 2000; ++tick) arm.step(1.0 / 400);
      const double stop = torque > 0 ? 0.4 : -0.7;
      EXPECT_NEAR(positions(arm)[0], stop + torque / stiffness, 1e-6);
      EXPECT_NEAR(velocities(arm)[0], 0.0, 1e-6);
    }
    arm.set_torques(std::vector{-20.0});
    for (int tick = 0; tick < 40; ++tick) arm.step(1.0 / 400);
    EXPECT_LT(positions(arm)[0], 0.35) << "a stop lets go";
  }
}

/// Positions and velocities after one second of random torques from `seed`.
std::vector<double> state_after_a_second(auto& arm, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> effort(-20.0, 20.0);
  for (int tick = 0; tick < 400; ++tick) {
    std::vector<double> torques;
    for (int i = 0; i < arm.links(); ++i) torques.push_back(effort(generator));
    arm.set_torques(torques);
    arm.step(1.0 / 400);
  }
  std::vector<double> state = positions(arm);
  const std::vector<double> v = velocities(arm);
  state.insert(state.end(), v.begin(), v.end());
  return state;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

ArmModel with_friction(ArmModel model) {
  for (ArmLink& link : model.links) link.coulomb_friction = 2.0;
  return model;
}

TYPED_TEST(EngineArm, TheSameInputsGiveTheSameBits) {
  const ArmModel model = with_friction(TypeParam::puma());
  typename TypeParam::Arm a(model), b(model);
  const std::vector<double> first = state_after_a_second(a, 7);
  EXPECT_TRUE(same_bits(first, state_after_a_second(b, 7)));
  EXPECT_FALSE(same_bits(first, state_after_a_second(b, 8)));
}

TYPED_TEST(EngineArm, ResetForgetsTheWholePast) {
  const ArmModel model = with_friction(TypeParam::puma());
  typename TypeParam::Arm fresh(model), used(model);
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  state_after_a_second(used, 3);
  fresh.reset(q);
  used.reset(q);
  EXPECT_TRUE(same_bits(state_after_a_second(fresh, 7), state_after_a_second(used, 7)));
}

TYPED_TEST(EngineArm, ATorqueThatIsNotFiniteCountsAsZeroAndIsRemembered) {
  for (const double bad : {std::nan(""), infinity, -infinity}) {
    typename TypeParam::Arm arm(turntable(0.5));
    arm.set_torques(std::vector{bad});
    arm.step(1.0 / 400);
    EXPECT_EQ(velocities(arm)[0], 0.0);
    arm.set_torques(std::vector{1.0});
    EXPECT_TRUE(arm.faults().torque);
    arm.step(1.0 / 400);
    EXPECT_GT(velocities(arm)[0], 0.0);
    arm.clear_faults();
    EXPECT_FALSE(arm.faults().torque);
  }
}

TYPED_TEST(EngineArm, AMissingTorqueCountsAsZeroAndIsRemembered) {
  typename TypeParam::Arm arm(TypeParam::puma());
  arm.set_torques(std::vector{1.0, 2.0});
  EXPECT_TRUE(arm.faults().torque);
}

TYPED_TEST(EngineArm, APeriodThatIsNotPositiveMovesNothing) {
  typename TypeParam::Arm arm(turntable(0.5));
  arm.set_torques(std::vector{1.0});
  for (const double bad : {0.0, -0.1, infinity, std::nan("")}) {
    arm.clear_faults();
    arm.step(bad);
    EXPECT_TRUE(arm.faults().period);
    EXPECT_EQ(positions(arm)[0], 0.0);
  }
}

TYPED_TEST(EngineArm, SetUpRefusesOptionsAndStatesOutOfRange) {
  using Arm = typename TypeParam::Arm;
  const ArmModel model = TypeParam::puma();
  EXPECT_THROW(Arm(ArmModel{}), SetupError);
  EXPECT_THROW(Arm(model, {.substeps = 0}), SetupError);
  EXPECT_THROW(Arm(model, {.substeps = 4, .stop_stiffness = -1.0}), SetupError);
  Arm arm(model);
  EXPECT_THROW(arm.reset(std::vector(5, 0.0)), SetupError);
  EXPECT_THROW(arm.reset(std::vector(6, 3.0)), SetupError);
  EXPECT_THROW(arm.reset(std::vector(6, 100.0)), SetupError);
  EXPECT_THROW(arm.reset(std::vector(6, std::nan(""))), SetupError);
  Arm free(turntable(1.0));
  EXPECT_THROW(free.reset(std::vector{infinity}), SetupError);
  EXPECT_THROW(free.reset(std::vector{0.0}, std::vector{infinity}), SetupError);
}

}  // namespace arm_test
}  // namespace repel::simulated
