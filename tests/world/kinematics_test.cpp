// SPDX-License-Identifier: BSD-3-Clause
// Identities that hold for every arm: derivatives compared with finite differences.
#include <repel/world/kinematics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "world/arms.hpp"

namespace repel {
namespace kinematics_test {

constexpr unsigned seed = 20240501;
constexpr double step = 1e-6;

/// Calls `check(arm, kinematics, q)` at random poses of every arm.
template <class Check>
void at_random_poses(Check check) {
  for (const ArmModel& arm : {test::skewed_arm(), test::six_joint_arm()}) {
    SCOPED_TRACE(arm.name + ", seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Kinematics kinematics(arm);
    for (int sample = 0; sample < 20; ++sample) {
      const auto q = test::random_joints(arm, random);
      kinematics.update(q);
      check(arm, kinematics, q);
    }
  }
}

std::vector<double> moved(std::vector<double> q, int joint, double by) {
  q[static_cast<std::size_t>(joint)] += by;
  return q;
}

/// Potential energy of the arm [J].
double potential_energy(const ArmModel& arm, const Kinematics& kinematics) {
  double energy = 0.0;
  for (int i = 0; i < kinematics.links(); ++i) {
    const ArmLink& link = arm.links[static_cast<std::size_t>(i)];
    energy -= link.mass * arm.gravity_W.dot(kinematics.X_WL(i) * link.p_LC);
  }
  return energy;
}

TEST(Kinematics, LinkPosesAreTheProductOfJointPoses) {
  at_random_poses([](const ArmModel& arm, const Kinematics& kinematics, const auto& q) {
    Pose X_WL = arm.X_WB;
    for (int i = 0; i < kinematics.links(); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const ArmLink& link = arm.links[n];
      X_WL = X_WL * link.X_PJ;
      if (link.type == JointType::revolute) X_WL.rotate(Eigen::AngleAxisd(q[n], link.axis_J));
      if (link.type == JointType::prismatic) X_WL.translate(Vec3(q[n] * link.axis_J));
      EXPECT_TRUE(kinematics.X_WL(i).isApprox(X_WL, 1e-13)) << "link " << i;
    }
    EXPECT_TRUE(kinematics.X_WT().isApprox(X_WL * arm.X_LT, 1e-13));
    EXPECT_TRUE(kinematics.X_WL(-1).isApprox(arm.X_WB, 0.0));
  });
}

TEST(Kinematics, JacobianEqualsFiniteDifferencesForAPointOfEveryLink) {
  at_random_poses([](const ArmModel& arm, const Kinematics& kinematics, const auto& q) {
    const Vec3 p_LQ(0.1, -0.2, 0.3);
    Kinematics ahead(arm), behind(arm);
    Jacobian J(6, kinematics.links());
    for (int link = -1; link < kinematics.links(); ++link) {
      kinematics.jacobian(link, kinematics.X_WL(link) * p_LQ, J);
      for (int joint = 0; joint < kinematics.links(); ++joint) {
        ahead.update(moved(q, joint, step));
        behind.update(moved(q, joint, -step));
        const Pose &X_a = ahead.X_WL(link), &X_b = behind.X_WL(link);
        const Vec3 linear = (X_a * p_LQ - X_b * p_LQ) / (2.0 * step);
        const Eigen::AngleAxisd turn(Mat3(X_a.linear() * X_b.linear().transpose()));
        const Vec3 angular = turn.angle() / (2.0 * step) * turn.axis();
        EXPECT_LT((J.col(joint).head<3>() - linear).norm(), 1e-8) << link << ", " << joint;
        EXPECT_LT((J.col(joint).tail<3>() - angular).norm(), 1e-8) << link << ", " << joint;
      }
    }
  });
}

TEST(Kinematics, ToolJacobianIsTheOneOfTheLastLinkAtTheToolOrigin) {
  at_random_poses([](const ArmModel&, const Kinematics& kinematics, const auto&) {
    Jacobian J(6, kinematics.links()), J_tool(6, kinematics.links());
    kinematics.jacobian(kinematics.links() - 1, kinematics.X_WT().translation(), J);
    kinematics.tool_jacobian(J_tool);
    EXPECT_EQ(J, J_tool);
  });
}

TEST(Kinematics, GravityTorquesAreTheGradientOfPotentialEnergy) {
  at_random_poses([](const ArmModel& arm, Kinematics& kinematics, const auto& q) {
    std::vector<double> torques(q.size());
    kinematics.gravity_torques(torques);
    Kinematics other(arm);
    for (int joint = 0; joint < kinematics.links(); ++joint) {
      other.update(moved(q, joint, step));
      const double ahead = potential_energy(arm, other);
      other.update(moved(q, joint, -step));
      const double slope = (ahead - potential_energy(arm, other)) / (2.0 * step);
      EXPECT_NEAR(torques[static_cast<std::size_t>(joint)], slope, 1e-6) << "joint " << joint;
    }
  });
}

TEST(Kinematics, MassMatrixIsThatOfTheLinksMovingWithTheirJacobians) {
  at_random_poses([](const ArmModel& arm, const Kinematics& kinematics, const auto&) {
    const int n = kinematics.links();
    Eigen::MatrixXd M, expected = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      const ArmLink& link = arm.links[static_cast<std::size_t>(i)];
      const Pose X_WL = kinematics.X_WL(i);
      Jacobian J(6, n);
      kinematics.jacobian(i, X_WL * link.p_LC, J);
      const Mat3 I_W = X_WL.linear() * link.I_C_L * X_WL.linear().transpose();
      expected += link.mass * J.topRows<3>().transpose() * J.topRows<3>() +
                  J.bottomRows<3>().transpose() * I_W * J.bottomRows<3>();
      expected(i, i) += link.rotor_inertia;
    }
    ASSERT_TRUE(kinematics.mass_matrix(M));
    EXPECT_LT((M - expected).norm(), 1e-12 * expected.norm()) << M;
  });
}

TEST(Kinematics, ACopyMovesByItself) {
  Kinematics kinematics(test::six_joint_arm());
  const Kinematics still = kinematics;
  kinematics.update(std::vector<double>(6, 0.5));
  EXPECT_FALSE(kinematics.X_WT().isApprox(still.X_WT()));
  EXPECT_TRUE(still.X_WT().isApprox(Kinematics(test::six_joint_arm()).X_WT(), 0.0));
}

TEST(Kinematics, JacobianFillsAFixedSizeMatrixToo) {
  Kinematics kinematics(test::six_joint_arm());
  Eigen::Matrix<double, 6, 6> fixed;
  Eigen::MatrixXd dynamic(6, 6);
  kinematics.tool_jacobian(fixed);
  kinematics.tool_jacobian(dynamic);
  EXPECT_EQ(fixed, dynamic);
}

TEST(Kinematics, AnAngleThatIsNotFiniteShowsInThePoseAndIsForgottenByTheNextUpdate) {
  const ArmModel arm = test::six_joint_arm();
  Kinematics kinematics(arm);
  const Pose X_WT = kinematics.X_WT();
  std::vector<double> q(6, 0.0), torques(6);
  q[2] = std::numeric_limits<double>::quiet_NaN();
  kinematics.update(q);
  kinematics.gravity_torques(torques);
  EXPECT_FALSE(is_finite(kinematics.X_WT()));
  EXPECT_FALSE(std::isfinite(torques[1]));
  q[2] = 0.0;
  kinematics.update(q);
  kinematics.gravity_torques(torques);
  EXPECT_TRUE(kinematics.X_WT().isApprox(X_WT, 0.0));
  EXPECT_TRUE(std::isfinite(torques[1]));
}

TEST(Kinematics, ArmsWithoutLinksOrWithBrokenNumbersAreRefused) {
  EXPECT_THROW(Kinematics{ArmModel{}}, SetupError);
  ArmModel arm = test::skewed_arm();
  arm.links[1].mass = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Kinematics{arm}, SetupError);
  arm = test::skewed_arm();
  arm.links[2].axis_J *= 2.0;
  EXPECT_THROW(Kinematics{arm}, SetupError);
}

}  // namespace kinematics_test
}  // namespace repel
