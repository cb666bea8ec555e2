// SPDX-License-Identifier: BSD-3-Clause
// Properties of the Bullet arm other than its mechanics: what a diverged motion leaves, set-up
// errors, and no allocation in a step. What every engine has is in tests/engines.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

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

#ifndef REPEL_SANITIZED
TEST(BulletArm, AStepAllocatesNothing) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) link.coulomb_friction = 2.0;
  Arm arm(model);
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

}  // namespace arm_contract_test
}  // namespace repel::bullet::test
