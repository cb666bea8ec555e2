// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/arm_inertia.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "loop/slider.hpp"

namespace repel {
namespace arm_inertia_test {

/// A link of 2 kg that rotates about z at the end of an arm of 0.5 m, and one of 1 kg 0.3 m
/// further.
struct TwoLinks : ArmKinematics {
  TwoLinks() {
    for (int i = 0; i < 2; ++i) {
      ArmLink link;
      link.mass = 2.0 - i;
      link.p_LC = Vec3(i == 0 ? 0.5 : 0.3, 0.0, 0.0);
      link.X_PJ.translation().x() = i == 0 ? 0.0 : 0.8;
      link.I_C_L = Mat3::Identity() * 0.01;
      link.rotor_inertia = 0.1;
      model.links.push_back(link);
    }
  }
  void update(std::span<const double> joints) noexcept override { q = {joints[0], joints[1]}; }
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    Pose X = Pose(Eigen::AngleAxisd(q[0], Vec3::UnitZ()));
    if (link == 0) return X;
    X = X * model.links[1].X_PJ;
    return X * Eigen::AngleAxisd(q[1], Vec3::UnitZ());
  }
  [[nodiscard]] Pose X_WT() const noexcept override { return X_WL(1); }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    J.setZero();
    for (int i = 0; i <= link; ++i) {
      J.col(i).head<3>() = Vec3::UnitZ().cross(p_WQ - X_WL(i).translation());
      J.col(i).tail<3>() = Vec3::UnitZ();
    }
  }
  void tool_jacobian(JacobianRef J) const noexcept override {
    jacobian(1, X_WT().translation(), J);
  }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }

  ArmModel model;
  std::array<double, 2> q{};
};

TEST(ArmInertia, IsThatOfTheTextbookForTwoLinks) {
  TwoLinks arm;
  ArmInertia inertia(arm.model);
  for (const double elbow : {0.0, 1.0, -2.0}) {
    arm.q = {0.3, elbow};
    inertia.begin_anew();
    ASSERT_TRUE(inertia.update(arm));
    const double c = std::cos(elbow);
    const double own = 0.01 + 1.0 * 0.3 * 0.3;
    EXPECT_NEAR(inertia.matrix()(1, 1), own + 0.1, 1e-12);
    EXPECT_NEAR(inertia.matrix()(0, 1), own + 1.0 * 0.8 * 0.3 * c, 1e-12);
    EXPECT_NEAR(inertia.matrix()(1, 0), inertia.matrix()(0, 1), 0.0);
    EXPECT_NEAR(inertia.matrix()(0, 0),
                0.1 + 0.01 + 2.0 * 0.25 + own + 0.8 * 0.8 + 2.0 * 0.8 * 0.3 * c, 1e-12);
  }
}

TEST(ArmInertia, AJointOfWhichNoMassIsKnownMovesAHundredthOfItsEffort) {
  ArmModel model = test::slider_model(300.0);
  model.links[1].rotor_inertia = 0.0;
  ArmInertia inertia(model);
  ASSERT_TRUE(inertia.update(test::SliderKinematics()));
  EXPECT_EQ(inertia.matrix()(0, 0), 5.0);
  EXPECT_EQ(inertia.matrix()(1, 1), 3.0);
  EXPECT_EQ(inertia.missing(), 1);
  ArmInertia::Vector p;
  inertia.momenta(std::vector{1.0, 2.0, 0.0}, p);
  EXPECT_EQ(p(0), 5.0);
  EXPECT_EQ(p(1), 6.0);
  EXPECT_EQ(p(2), 0.0);
}

/// An arm whose manufacturer provides the mass matrix.
struct GivenMass : test::SliderKinematics {
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    M << 3.0, 0.5, 0.0, 0.5, 2.0, 0.0, 0.0, 0.0, 1.0;
    return true;
  }
};

TEST(ArmInertia, IsWhatTheKinematicsSayItIsWhereTheySayIt) {
  ArmModel model = test::slider_model(300.0);
  for (ArmLink& link : model.links) link.mass = 100.0;
  ArmInertia inertia(model);
  ASSERT_TRUE(inertia.update(GivenMass()));
  EXPECT_EQ(inertia.missing(), -1);
  EXPECT_EQ(inertia.matrix()(0, 0), 3.0);
  EXPECT_EQ(inertia.matrix()(0, 1), 0.5);
  EXPECT_EQ(inertia.matrix()(2, 2), 1.0);
}

/// A mass matrix that goes wrong.
struct WrongMass : test::SliderKinematics {
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    M = given;
    return true;
  }
  Eigen::MatrixXd given = 5.0 * Eigen::MatrixXd::Identity(3, 3);
};

// One NaN stayed in what hard walls remember; one off the diagonal was sent to the drive.
TEST(ArmInertia, AMatrixThatIsNoneIsNotTaken) {
  const ArmModel model = test::slider_model(300.0);
  const auto wrong = [&](const auto& spoil) {
    ArmInertia inertia(model);
    WrongMass arm;
    EXPECT_TRUE(inertia.update(arm));
    spoil(arm.given);
    const bool taken = inertia.update(arm);
    EXPECT_EQ(inertia.matrix()(0, 0), taken ? arm.given(0, 0) : 5.0);
    EXPECT_EQ(inertia.matrix()(0, 1), taken ? arm.given(0, 1) : 0.0);
    return !taken;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(wrong([](Eigen::MatrixXd& M) { M(0, 1) = M(1, 0) = 4.0; }));
  EXPECT_TRUE(wrong([&](Eigen::MatrixXd& M) { M(0, 0) = nan; }));
  EXPECT_TRUE(wrong([&](Eigen::MatrixXd& M) { M(0, 1) = M(1, 0) = nan; }));
  EXPECT_TRUE(wrong([&](Eigen::MatrixXd& M) { M(0, 1) = nan; }));
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M(0, 1) = 2.0; })) << "not symmetric";
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M(0, 1) = M(1, 0) = 6.0; })) << "not positive";
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M = -M; }));
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M.setZero(); }));
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M *= 1e6; }));
  EXPECT_TRUE(wrong([](Eigen::MatrixXd& M) { M *= 1e-6; }));
}

TEST(ArmInertia, AnEffortThatIsNotKnownIsBoundedByWhatTheJointCarries) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(effort_bound(test::slider_model(300.0), 0), 300.0);
  for (const double unknown : {0.0, infinite}) {
    EXPECT_EQ(effort_bound(test::slider_model(unknown), 0), 1000.0);
  }
  TwoLinks arm;
  EXPECT_EQ(effort_bound(arm.model, 1), 200.0);
  arm.model.links[1].mass = 50.0;
  const double carried = 2.0 * 9.81 * (2.0 * 0.5 + 50.0 * 1.1);
  EXPECT_GT(effort_bound(arm.model, 0), carried);
  EXPECT_LT(effort_bound(arm.model, 0), 1e4);
}

}  // namespace arm_inertia_test
}  // namespace repel
