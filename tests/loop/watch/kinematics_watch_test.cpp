// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/kinematics_watch.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace repel {
namespace kinematics_watch_test {

/// Two links of 0.5 m that turn about z; a third joint turns the tool about x.
struct Arm {
  std::vector<double> q{0.3, 0.8, -0.2};
  [[nodiscard]] Pose X_WT() const {
    Pose X = Pose::Identity();
    X.translation() = p();
    X.linear() =
        (Eigen::AngleAxisd(q[0] + q[1], Vec3::UnitZ()) * Eigen::AngleAxisd(q[2], Vec3::UnitX()))
            .toRotationMatrix();
    return X;
  }
  [[nodiscard]] Vec3 p() const {
    return {0.5 * (std::cos(q[0]) + std::cos(q[0] + q[1])),
            0.5 * (std::sin(q[0]) + std::sin(q[0] + q[1])), 0.0};
  }
  [[nodiscard]] Jacobian J() const {
    Jacobian out = Jacobian::Zero(6, 3);
    const Vec3 elbow(0.5 * std::cos(q[0]), 0.5 * std::sin(q[0]), 0.0);
    out.col(0).head<3>() = Vec3::UnitZ().cross(p());
    out.col(1).head<3>() = Vec3::UnitZ().cross(Vec3(p() - elbow));
    out(5, 0) = out(5, 1) = 1.0;
    out.col(2).tail<3>() = Vec3(std::cos(q[0] + q[1]), std::sin(q[0] + q[1]), 0.0);
    return out;
  }
};

struct Watched {
  KinematicsWatch watch{{100.0, 100.0, 10.0}};
  Arm arm;
  Watched() { watch.keep(arm.q, arm.X_WT(), arm.J()); }
  void move(double by) {
    for (double& q : arm.q) q += by;
  }
  [[nodiscard]] bool agrees(const Pose& X, const Jacobian& J) const {
    return watch.agrees(arm.q, X, J);
  }
};

TEST(KinematicsWatch, BelievesAnArmThatMoves) {
  Watched w;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-0.02, 0.02);
  for (int tick = 0; tick < 20000; ++tick) {
    for (double& q : w.arm.q) q += step(random);
    ASSERT_TRUE(w.agrees(w.arm.X_WT(), w.arm.J())) << tick;
    w.watch.keep(w.arm.q, w.arm.X_WT(), w.arm.J());
  }
}

TEST(KinematicsWatch, APoseMustMoveAsTheJacobianSays) {
  for (const double by : {0.0, 1e-4, 0.01}) {
    Watched w;
    w.move(by);
    const Pose sound = w.arm.X_WT();
    ASSERT_TRUE(w.agrees(sound, w.arm.J()));
    Pose jumped = sound;
    jumped.translation().x() += 0.01;
    EXPECT_FALSE(w.agrees(jumped, w.arm.J())) << by;
    Pose turned = sound;
    turned.linear() = turned.linear() * Eigen::AngleAxisd(0.01, Vec3::UnitY());
    EXPECT_FALSE(w.agrees(turned, w.arm.J())) << by;
  }
}

TEST(KinematicsWatch, APoseThatStandsStillIsNoticedAfterAMillimetre) {
  Watched w;
  const Pose frozen = w.arm.X_WT();
  int ticks = 0;
  while (w.agrees(frozen, w.arm.J())) {
    w.move(1e-5);
    w.watch.keep(w.arm.q, frozen, w.arm.J());
    ASSERT_LT(++ticks, 100);
  }
}

TEST(KinematicsWatch, AJacobianDoesNotJump) {
  Watched w;
  const Pose X = w.arm.X_WT();
  Jacobian J = w.arm.J();
  J(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(w.agrees(X, J));
  EXPECT_FALSE(w.agrees(X, 2.0 * w.arm.J()));
  EXPECT_FALSE(w.agrees(X, -w.arm.J()));
  EXPECT_FALSE(w.agrees(X, Jacobian::Zero(6, 3)));
  J = w.arm.J();
  J.col(0).swap(J.col(2));
  EXPECT_FALSE(w.agrees(X, J));
}

// A weight of 1e6 N m was followed.
TEST(KinematicsWatch, AWeightDoesNotJumpEither) {
  Watched w;
  std::vector<double> g{40.0, -10.0, 1.0};
  ASSERT_TRUE(w.watch.believe(w.arm.q, g));
  w.move(1e-3);
  g = {40.1, -10.1, 1.01};
  ASSERT_TRUE(w.watch.believe(w.arm.q, g));
  for (const double wrong : {1e6, -40.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    g = {wrong, -10.1, 1.01};
    EXPECT_FALSE(w.watch.believe(w.arm.q, g)) << wrong;
    EXPECT_EQ(g[0], 40.1) << "the last one believed stays";
  }
}

}  // namespace kinematics_watch_test
}  // namespace repel
