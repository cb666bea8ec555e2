// SPDX-License-Identifier: BSD-3-Clause
#include <repel/ideal/arm.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "simulated/brakes.hpp"

namespace repel {
namespace ideal_arm_test {

static_assert(noexcept(std::declval<IdealArm&>().step(0.0)));

TEST(IdealArm, EachJointAnswersItsOwnTorqueOverItsOwnInertia) {
  IdealArm arm(std::vector<IdealJoint>{{2.0, 0.0}, {0.5, 0.0}});
  arm.set_torques(std::vector{3.0, -1.0});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  std::vector<double> q(2), v(2);
  arm.read_positions(q);
  arm.read_velocities(v);
  EXPECT_NEAR(v[0], 1.5, 1e-12);
  EXPECT_NEAR(v[1], -2.0, 1e-12);
  EXPECT_NEAR(q[0], 0.5 * 1.5,
              0.5 * 1.5 / 400 + 1e-12);  // half a step ahead, an error of the scheme
  EXPECT_NEAR(q[1], 0.5 * -2.0, 0.5 * 2.0 / 400 + 1e-12);
}

TEST(IdealArm, ViscousFrictionEndsInTorqueOverFrictionHoweverStrong) {
  IdealArm arm(std::vector<IdealJoint>{{2.0, 0.5}, {1e-6, 1e6}});
  arm.set_torques(std::vector{3.0, 1e6});
  for (int tick = 0; tick < 400 * 100; ++tick) arm.step(1.0 / 400);
  std::vector<double> v(2);
  arm.read_velocities(v);
  EXPECT_NEAR(v[0], 6.0, 1e-9);
  EXPECT_NEAR(v[1], 1.0, 1e-9);
}

TEST(IdealArm, ATorqueThatIsNotFiniteCountsAsZeroAndIsRemembered) {
  IdealArm arm(std::vector<IdealJoint>(1));
  arm.set_torques(std::vector{std::nan("")});
  arm.step(1.0);
  std::vector<double> v(1);
  arm.read_velocities(v);
  EXPECT_EQ(v[0], 0.0);
  EXPECT_TRUE(arm.torque_fault());
  arm.clear_fault();
  EXPECT_FALSE(arm.torque_fault());
}

TEST(IdealArm, ResetPutsItAtRestWhereAsked) {
  IdealArm arm(std::vector<IdealJoint>(2));
  arm.set_torques(std::vector{1.0, 1.0});
  arm.step(1.0);
  arm.reset(std::vector{0.3, -0.4});
  arm.step(1.0);
  std::vector<double> q(2);
  arm.read_positions(q);
  EXPECT_EQ(q, (std::vector{0.3, -0.4}));
}

TEST(IdealArm, SetUpRefusesWhatHasNoMotion) {
  EXPECT_THROW(IdealArm(std::vector<IdealJoint>{}), SetupError);
  EXPECT_THROW(IdealArm(std::vector<IdealJoint>{{0.0, 0.0}}), SetupError);
  EXPECT_THROW(IdealArm(std::vector<IdealJoint>{{1.0, -1.0}}), SetupError);
  IdealArm arm(std::vector<IdealJoint>(2));
  EXPECT_THROW(arm.reset(std::vector{0.0}), SetupError);
}

TEST(IdealArm, ItsDriveStopsAndHoldsItAndGoesOn) {
  const auto two = [](double seconds) {
    return IdealArm(std::vector<IdealJoint>{{0.5, 0.1, 3.0}, {2.0, 0.0}}, {.watchdog = seconds});
  };
  const auto free = [](double seconds) {
    return IdealArm(std::vector<IdealJoint>{{0.5, 0.0, 3.0}}, {.watchdog = seconds});
  };
  simulated::expect_a_sound_drive(two, {1.0, -2.0});
  simulated::expect_a_stop_to_forget_what_was_sent(free);
  EXPECT_THROW((IdealArm(std::vector<IdealJoint>{{1.0, 0.0, -1.0}})), SetupError);
  EXPECT_THROW(two(-1.0), SetupError);
}

}  // namespace ideal_arm_test
}  // namespace repel
