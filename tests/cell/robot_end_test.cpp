// SPDX-License-Identifier: BSD-3-Clause
// The least masses of an arm over its workspace.
#include <repel/cell/robot_end.hpp>

#include <gtest/gtest.h>

#include <set>

#include "cell/sliders.hpp"

namespace repel {
namespace robot_end_test {

/// A rod of 1 m and 3 kg at its end that turns about z, on a cart of 2 kg that slides along x.
struct CartAndRod final : ArmKinematics {
  void update(std::span<const double> q) noexcept override {
    angle = q[1];
    ++updates;
    seen.insert(q[1]);
  }
  Pose X_WT() const noexcept override { return Pose::Identity(); }
  void gravity_torques(std::span<double> out) noexcept override { out[0] = out[1] = 0.0; }
  void tool_jacobian(JacobianRef J) const noexcept override {
    J.setZero();
    J(0, 0) = 1.0;
    J(0, 1) = -std::sin(angle);
    J(1, 1) = std::cos(angle);
    J(5, 1) = 1.0;
  }
  bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    M.resize(2, 2);
    M << 5.0, -3.0 * std::sin(angle), -3.0 * std::sin(angle), 3.0;
    return true;
  }
  double angle = 0.0;
  int updates = 0;
  std::set<double> seen;
};

ArmDescription cart_and_rod() {
  ArmDescription arm;
  arm.model.links = {{.type = JointType::prismatic, .lower = -1.0, .upper = 1.0},
                     {.lower = -3.0, .upper = 3.0}};
  arm.start = {0.0, 0.0};
  arm.kinematics = std::make_unique<CartAndRod>();
  return arm;
}

TEST(RobotEndOfAnArm, IsItsLightestDirectionInItsLightestPose) {
  const ArmDescription arm = cart_and_rod();
  const network::RobotEnd robot = robot_end(arm, 0.001);
  // Along the rod both masses move, across it the end of the rod alone: 3 kg in every pose.
  EXPECT_NEAR(robot.mass, 3.0 / 1.7, 1e-9);
  // The cart alone is lightest with the rod across the rail: 2 kg, as the rod may turn freely.
  EXPECT_GT(robot.joints(0), 2.0 / 1.7 - 1e-9);
  EXPECT_LT(robot.joints(0), 2.05 / 1.7);
  // The rod about the cart, which is free: 3 - 9 sin^2 / 5, least across the rail.
  EXPECT_GT(robot.joints(1), 1.2 / 1.7 - 1e-9);
  EXPECT_LT(robot.joints(1), 1.25 / 1.7);
  EXPECT_NEAR(robot.inertia, robot.joints(1), 1e-9);
  EXPECT_DOUBLE_EQ(robot.response, 0.0015);
  EXPECT_DOUBLE_EQ(robot.wall_ticks, 0.5);
}

TEST(RobotEndOfAnArm, LooksAtManyPosesAndLeavesTheArmAtItsStart) {
  const ArmDescription arm = cart_and_rod();
  auto& kinematics = static_cast<CartAndRod&>(*arm.kinematics);
  (void)robot_end(arm, 0.001);
  EXPECT_GT(kinematics.seen.size(), 60U);
  EXPECT_LT(*kinematics.seen.begin(), -2.5);
  EXPECT_GT(*kinematics.seen.rbegin(), 2.5);
  EXPECT_EQ(kinematics.angle, 0.0);
}

TEST(RobotEndOfAnArm, ALateDriveAnswersLater) {
  ArmDescription arm = cart_and_rod();
  arm.options.drive_delay = 2.0;
  const network::RobotEnd robot = robot_end(arm, 0.001);
  EXPECT_DOUBLE_EQ(robot.response, 0.0065);
  EXPECT_DOUBLE_EQ(robot.wall_ticks, 4.5);
}

}  // namespace robot_end_test
}  // namespace repel
