// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/arm_kinematics.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace arm_kinematics_test {

/// Knows only its tool.
struct ToolAlone final : ArmKinematics {
  void update(std::span<const double> /*q*/) noexcept override {}
  [[nodiscard]] Pose X_WT() const noexcept override { return Pose::Identity(); }
  void tool_jacobian(JacobianRef J) const noexcept override { J.setZero(); }
  void gravity_torques(std::span<double> /*out*/) noexcept override {}
};

// An unknown pose must not be mistaken for a valid one.
TEST(ArmKinematics, WhatTheyDoNotKnowIsNotANumber) {
  const ToolAlone kinematics;
  EXPECT_FALSE(is_finite(kinematics.X_WL(0)));
  Jacobian J = Jacobian::Zero(6, 2);
  kinematics.jacobian(0, Vec3::Zero(), J);
  EXPECT_TRUE(J.array().isNaN().all());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_FALSE(kinematics.mass_matrix(M));
}

}  // namespace arm_kinematics_test
}  // namespace repel
