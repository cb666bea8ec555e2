// SPDX-License-Identifier: BSD-3-Clause
// Properties of the simulated arm other than its mechanics: the concept, determinism, faults,
// set-up errors, and no allocation in a step.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <random>

#include <repel/base/setup_error.hpp>

#include "arms.hpp"

// Bullet and Eigen allocate by malloc, as does operator new, so malloc is counted. Not possible
// with a sanitizer, which replaces malloc itself.
#ifndef REPEL_SANITIZED
namespace {
std::atomic<long> allocations{0};
}

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace repel::bullet::test {
namespace arm_contract_test {

static_assert(noexcept(std::declval<Arm&>().step(0.0)));
static_assert(noexcept(std::declval<Arm&>().set_torques({})));
static_assert(noexcept(std::declval<const Arm&>().read_positions({})));
static_assert(noexcept(std::declval<const Arm&>().read_velocities({})));

/// Positions and velocities after one second of random torques from `seed`.
std::vector<double> state_after_a_second(Arm& arm, unsigned seed) {
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

ArmModel puma_with_friction() {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) link.coulomb_friction = 2.0;
  return model;
}

TEST(BulletArm, TheSameInputsGiveTheSameBits) {
  Arm a(puma_with_friction()), b(puma_with_friction());
  const std::vector<double> first = state_after_a_second(a, 7);
  EXPECT_TRUE(same_bits(first, state_after_a_second(b, 7)));
  EXPECT_FALSE(same_bits(first, state_after_a_second(b, 8)));
}

TEST(BulletArm, ResetForgetsTheWholePast) {
  Arm fresh(puma_with_friction()), used(puma_with_friction());
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  state_after_a_second(used, 3);
  fresh.reset(q);
  used.reset(q);
  EXPECT_TRUE(same_bits(state_after_a_second(fresh, 7), state_after_a_second(used, 7)));
}

#ifndef REPEL_SANITIZED
TEST(BulletArm, AStepAllocatesNothing) {
  Arm arm(puma_with_friction());
  const std::vector torques{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  std::vector<double> out(6);
  const long before = allocations;
  for (int tick = 0; tick < 100; ++tick) {
    arm.engage_brakes(tick >= 50);
    arm.set_torques(torques);
    arm.step(1.0 / 400);
    arm.read_positions(out);
    arm.read_velocities(out);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the counter is not in the path";
}
#endif

TEST(BulletArm, ATorqueThatIsNotFiniteCountsAsZeroAndIsRemembered) {
  for (const double bad : {std::nan(""), infinity, -infinity}) {
    Arm arm(turntable(0.5));
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

TEST(BulletArm, AMissingTorqueCountsAsZeroAndIsRemembered) {
  Arm arm(puma560());
  arm.set_torques(std::vector{1.0, 2.0});
  EXPECT_TRUE(arm.faults().torque);
}

TEST(BulletArm, APeriodThatIsNotPositiveMovesNothing) {
  Arm arm(turntable(0.5));
  arm.set_torques(std::vector{1.0});
  for (const double bad : {0.0, -0.1, infinity, std::nan("")}) {
    arm.clear_faults();
    arm.step(bad);
    EXPECT_TRUE(arm.faults().period);
    EXPECT_EQ(positions(arm)[0], 0.0);
  }
}

TEST(BulletArm, ATorqueBeyondAllReasonLeavesAFiniteState) {
  Arm arm(puma560());
  arm.set_torques(std::vector(6, 1e308));
  for (int tick = 0; tick < 100; ++tick) arm.step(1.0 / 400);
  EXPECT_TRUE(arm.faults().state);
  for (const double q : positions(arm)) EXPECT_TRUE(std::isfinite(q));
  arm.reset(std::vector(6, 0.1));
  arm.clear_faults();
  arm.step(1.0 / 400);
  EXPECT_FALSE(arm.faults().state);
}

/// The message of the SetupError that `action` throws.
template <class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(BulletArm, SetUpNamesTheJointAndTheNumberThatIsWrong) {
  const auto with = [](auto change) {
    ArmModel model = puma560();
    change(model.links[2]);
    return message_of([&] { Arm arm(model); });
  };
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find("joint3"), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(with([](ArmLink& link) { link.mass = -1.0; }), "mass is -1 kg");
  expect(with([](ArmLink& link) { link.axis_J *= 2.0; }), "unit length");
  expect(with([](ArmLink& link) { link.I_C_L(0, 0) = -1.0; }), "negative principal moment");
  expect(with([](ArmLink& link) { link.I_C_L(0, 1) = 1.0; }), "symmetric");
  expect(with([](ArmLink& link) { link.X_PJ.linear() *= 1.1; }), "rigid");
  expect(with([](ArmLink& link) { link.lower = link.upper; }), "limits");
  expect(with([](ArmLink& link) { link.rotor_inertia = std::nan(""); }), "rotor inertia");
}

TEST(BulletArm, SetUpRefusesAJointThatMovesNoMass) {
  ArmModel model = puma560();
  model.links[5].mass = 0.0;
  model.links[5].I_C_L.setZero();
  const std::string message = message_of([&] { Arm arm(model); });
  EXPECT_NE(message.find("joint6"), std::string::npos) << message;
}

TEST(BulletArm, SetUpRefusesOptionsAndStatesOutOfRange) {
  EXPECT_THROW(Arm(ArmModel{}), SetupError);
  EXPECT_THROW(Arm(puma560(), {.substeps = 0}), SetupError);
  EXPECT_THROW(Arm(puma560(), {.substeps = 4, .stop_stiffness = -1.0}), SetupError);
  Arm arm(puma560());
  EXPECT_THROW(arm.reset(std::vector(5, 0.0)), SetupError);
  EXPECT_THROW(arm.reset(std::vector(6, 3.0)), SetupError);
  EXPECT_THROW(arm.reset(std::vector(6, std::nan(""))), SetupError);
  Arm free(turntable(1.0));
  EXPECT_THROW(free.reset(std::vector{infinity}), SetupError);
  EXPECT_THROW(free.reset(std::vector{0.0}, std::vector{infinity}), SetupError);
}

}  // namespace arm_contract_test
}  // namespace repel::bullet::test
