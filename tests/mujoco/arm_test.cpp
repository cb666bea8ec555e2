// SPDX-License-Identifier: BSD-3-Clause
// The MuJoCo arm: its mechanics, what becomes of errors of MuJoCo, and no allocation in a step.
// What every engine has is in tests/engines.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/mujoco/arm.hpp>

#include "simulated/arms.hpp"

// MuJoCo allocates by malloc, as does operator new, so malloc is counted. Not possible with a
// sanitizer, which replaces malloc itself.
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

namespace repel::mujoco {
namespace arm_test {

using namespace simulated;

constexpr double period = 1.0 / 400;

Pose at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

#ifndef REPEL_SANITIZED
TEST(MujocoArm, AStepAllocatesNothing) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) link.coulomb_friction = 2.0;
  const std::vector<Vec3> corners{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
  const std::vector<ContactPart> parts{{"hand", 5, Shape::box({0.04, 0.04, 0.1}), Pose::Identity()},
                                       {"thorn", 5, Shape::hull(corners), Pose::Identity()},
                                       {"table", -1, Shape::box({2.0, 2.0, 0.1}), at(0, 0, -0.4)}};
  Arm arm(model, {}, parts);
  arm.reset(std::vector{0.0, 0.6, -0.6, 0.2, 0.3, 0.0});
  const std::vector torques{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  std::vector<double> out(6);
  const long before = allocations;
  for (int tick = 0; tick < 800; ++tick) {
    arm.engage_brakes(tick >= 700);
    arm.set_torques(torques);
    arm.step(period);
    arm.read_positions(out);
    (void)arm.read_wrench();
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the counter is not in the path";
  EXPECT_GT(arm.contact().steps, 100);
}
#endif

TEST(MujocoArm, AnswersTorquesAsBothMassesAndRotorsSay) {
  ArmModel model = turntable(0.5);
  model.links[0].rotor_inertia = 1.5;
  Arm arm(model);
  EXPECT_NEAR(accelerations(arm, {0.0}, {0.0}, {4.0})[0], 2.0, 1e-6);
}

TEST(MujocoArm, FrictionHoldsBelowItsLimitAndOpposesBeyondIt) {
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

TEST(MujocoArm, AContactIsTheSpringOfItsStiffness) {
  ArmModel model = turntable(0.5);
  model.links[0].type = JointType::prismatic;
  model.links[0].mass = 2.0;
  for (const double stiffness : {1e4, 1e6}) {
    Arm arm(model, {.contact_stiffness = stiffness},
            std::vector<ContactPart>{{"ball", 0, Shape::sphere(0.1), Pose::Identity()},
                                     {"floor", -1, Shape::box({1.0, 1.0, 0.1}), at(0, 0, -0.2)}});
    for (int tick = 0; tick < 4000; ++tick) arm.step(period);
    EXPECT_NEAR(positions(arm)[0], -2.0 * 9.81 / stiffness, 1e-3 * 2.0 * 9.81 / stiffness);
    EXPECT_NEAR(arm.read_wrench()->force.z(), 2.0 * 9.81, 1e-6);
  }
}

TEST(MujocoArm, FacesThatMeetWithoutADepthHaveNoForce) {
  ArmModel model = turntable(0.5);
  model.links[0].type = JointType::prismatic;
  model.gravity_W.setZero();
  Arm arm(model, {},
          std::vector<ContactPart>{{"ball", 0, Shape::sphere(0.125), Pose::Identity()},
                                   {"floor", -1, Shape::box({1.0, 1.0, 0.25}), at(0, 0, -0.375)}});
  for (int tick = 0; tick < 100; ++tick) arm.step(period);
  EXPECT_EQ(positions(arm)[0], 0.0);
  EXPECT_EQ(arm.contact().steps, 0);
  EXPECT_EQ(arm.read_wrench()->force, Vec3::Zero());
}

TEST(MujocoArm, ATorqueBeyondAllReasonIsAFaultAndLeavesAFiniteState) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) link.coulomb_friction = 2.0;
  Arm arm(model);
  arm.set_torques(std::vector(6, 1e308));
  for (int tick = 0; tick < 100; ++tick) arm.step(period);
  EXPECT_TRUE(arm.faults().state);
  for (const double q : positions(arm)) EXPECT_TRUE(std::isfinite(q));
  arm.clear_faults();
  arm.reset(std::vector(6, 0.0));
  arm.step(period);
  EXPECT_FALSE(arm.faults().state);
}

TEST(MujocoArm, SetUpNamesTheJointThatMovesNoMassAndTheHullThatIsFlat) {
  const auto message = [](const ArmModel& model, const std::vector<ContactPart>& parts) {
    try {
      const Arm arm(model, {}, parts);
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
  };
  ArmModel model = turntable(0.5);
  model.links[0].mass = 0.0;
  model.links[0].I_C_L.setZero();
  EXPECT_NE(message(model, {}).find("'joint' moves no mass"), std::string::npos);
  model.links[0].rotor_inertia = 1.0;
  EXPECT_NO_THROW(Arm{model});
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::string flat = message(model, {{"good", -1, Shape::sphere(0.1), Pose::Identity()},
                                           {"leaf", -1, Shape::hull(corners), Pose::Identity()}});
  EXPECT_NE(flat.find("'leaf'"), std::string::npos) << flat;
}

std::string heard;
void hear(const char* message) {
  heard = message;
}

TEST(MujocoArm, ErrorsOfOthersReachTheirOwnHandler) {
  mju_user_error = &hear;
  mju_user_warning = &hear;
  Arm arm(puma560());
  arm.set_torques(std::vector(6, 1e308));
  for (int tick = 0; tick < 10; ++tick) arm.step(period);
  EXPECT_EQ(heard, "");
  mju_error("an error");
  EXPECT_EQ(heard, "an error");
  mju_warning("a warning");
  EXPECT_EQ(heard, "a warning");
}

}  // namespace arm_test
}  // namespace repel::mujoco
