// SPDX-License-Identifier: BSD-3-Clause
// The two PUMA 560 files compared with the published tables and with results published by others.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <tinyxml2.h>

#include "arms.hpp"

namespace repel {
namespace puma560_test {

using std::numbers::pi;
using Joints = std::array<double, 6>;
constexpr unsigned seed = 560;

struct Set {
  std::string file;
  bool modified;  // Denavit-Hartenberg parameters precede the joint
  Joints alpha, a, d;
  std::array<Vec3, 6> centres;  // [m] in the Denavit-Hartenberg frame of the link
  std::array<Vec3, 6> inertias;
  Joints rotor;
  Pose X_WD0;           // frame 0 in the world
  Joints lower, upper;  // degrees
};

Pose lifted(double turn) {
  return Pose(Eigen::Translation3d(0.0, 0.0, 0.672) * Eigen::AngleAxisd(turn, Vec3::UnitZ()));
}

/// P. Corke's standard set.
Set standard_set() {
  return {
      "robots/puma560.urdf",
      false,
      {pi / 2, 0, -pi / 2, pi / 2, -pi / 2, 0},
      {0, 0.4318, 0.0203, 0, 0, 0},
      {0, 0, 0.15005, 0.4318, 0, 0},
      {Vec3::Zero(), Vec3(-0.3638, 0.006, 0.2275), Vec3(-0.0203, -0.0141, 0.070), Vec3(0, 0.019, 0),
       Vec3::Zero(), Vec3(0, 0, 0.032)},
      {Vec3(0.35, 0.35, 0.35), Vec3(0.13, 0.524, 0.539), Vec3(0.066, 0.086, 0.0125),
       Vec3(1.8e-3, 1.3e-3, 1.8e-3), Vec3(0.3e-3, 0.4e-3, 0.3e-3), Vec3(0.15e-3, 0.15e-3, 0.04e-3)},
      {200e-6, 200e-6, 200e-6, 33e-6, 33e-6, 33e-6},
      lifted(0.0),
      {-160, -45, -225, -110, -100, -266},
      {160, 225, 45, 170, 100, 266}};
}

/// The modified set of Armstrong, Khatib and Burdick.
Set modified_set() {
  return {
      "robots/puma560_armstrong.urdf",
      true,
      {0, -pi / 2, 0, pi / 2, -pi / 2, pi / 2},
      {0, 0, 0.4318, -0.0203, 0, 0},
      {0, 0.2435, -0.0934, 0.4331, 0, 0},
      {Vec3::Zero(), Vec3(0.068, 0.006, -0.016), Vec3(0, -0.070, 0.014), Vec3(0, 0, -0.019),
       Vec3::Zero(), Vec3(0, 0, 0.032)},
      {Vec3(0.35, 0.35, 0.35), Vec3(0.13, 0.524, 0.539), Vec3(0.066, 0.0125, 0.066),
       Vec3(1.8e-3, 1.8e-3, 1.3e-3), Vec3(0.3e-3, 0.3e-3, 0.4e-3), Vec3(0.15e-3, 0.15e-3, 0.04e-3)},
      {291e-6, 409e-6, 299e-6, 35e-6, 35e-6, 35e-6},
      lifted(pi),
      {-160, -225, -45, -110, -100, -266},
      {160, 45, 225, 170, 100, 266}};
}

constexpr Joints masses = {10.0, 17.4, 4.8, 0.82, 0.34, 0.09};
constexpr Joints gears = {-62.6111, 107.815, -53.7063, 76.0364, 71.923, 76.686};
constexpr Joints torque_limits = {97.6, 186.4, 89.4, 24.2, 20.1, 21.3};

/// Denavit-Hartenberg frame i in frame i - 1.
Pose dh_step(const Set& set, std::size_t i, double q) {
  const auto turn = Eigen::AngleAxisd(q, Vec3::UnitZ()) * Eigen::Translation3d(0, 0, set.d[i]);
  const auto twist =
      Eigen::Translation3d(set.a[i], 0, 0) * Eigen::AngleAxisd(set.alpha[i], Vec3::UnitX());
  return set.modified ? Pose(twist * turn) : Pose(turn * twist);
}

/// Joint angles of the same pose of the robot in the modified set.
Joints to_modified(Joints q) {
  q[1] -= pi;
  q[2] += pi;
  return q;
}

Joints gravity_of(const std::string& file, const Joints& q, double g) {
  ArmModel arm = load_arm(file).arm;
  arm.gravity_W = {0.0, 0.0, -g};
  Kinematics kinematics(arm);
  kinematics.update(q);
  Joints torques;
  kinematics.gravity_torques(torques);
  return torques;
}

class Puma560 : public testing::TestWithParam<Set> {
 protected:
  const Set& set = GetParam();
  const Robot robot = load_arm(set.file);
};
INSTANTIATE_TEST_SUITE_P(BothSets, Puma560, testing::Values(standard_set(), modified_set()),
                         [](const auto& tested) {
                           return tested.param.modified ? "Armstrong" : "Standard";
                         });

TEST_P(Puma560, ForwardKinematicsEqualsTheDenavitHartenbergProduct) {
  Kinematics kinematics(robot.arm);
  std::mt19937_64 random(seed);
  for (int sample = 0; sample < 200; ++sample) {
    const auto q = test::random_joints(robot.arm, random);
    kinematics.update(q);
    Pose X_WD = set.X_WD0;
    for (std::size_t i = 0; i < 6; ++i) X_WD = X_WD * dh_step(set, i, q[i]);
    const Pose X_WT = X_WD * Eigen::Translation3d(0, 0, 0.05334) *
                      Eigen::AngleAxisd(set.modified ? pi : 0.0, Vec3::UnitZ());
    EXPECT_LT((kinematics.X_WT().matrix() - X_WT.matrix()).cwiseAbs().maxCoeff(), 1e-12)
        << "seed " << seed << ", sample " << sample;
  }
}

TEST_P(Puma560, MassCentresAndInertiasAreThePublishedOnesInTheirPublishedFrames) {
  Kinematics kinematics(robot.arm);
  Pose X_WD = set.X_WD0;
  for (std::size_t i = 0; i < 6; ++i) {
    X_WD = X_WD * dh_step(set, i, 0.0);
    const ArmLink& link = robot.arm.links[i];
    const Pose X_DL = X_WD.inverse() * kinematics.X_WL(static_cast<int>(i));
    const Mat3 I_C_D = X_DL.linear() * link.I_C_L * X_DL.linear().transpose();
    EXPECT_EQ(link.mass, masses[i]) << link.name;
    EXPECT_LT((X_DL * link.p_LC - set.centres[i]).norm(), 1e-12) << link.name;
    EXPECT_LT((I_C_D - Mat3(set.inertias[i].asDiagonal())).norm(), 1e-12) << link.name;
  }
}

TEST_P(Puma560, LimitsAreThePublishedOnes) {
  for (std::size_t i = 0; i < 6; ++i) {
    const ArmLink& link = robot.arm.links[i];
    EXPECT_NEAR(link.lower * 180 / pi, set.lower[i], 1e-9) << link.name;
    EXPECT_NEAR(link.upper * 180 / pi, set.upper[i], 1e-9) << link.name;
    EXPECT_EQ(link.effort_limit, torque_limits[i]) << link.name;
    EXPECT_GT(link.velocity_limit, 0.0) << link.name;
  }
}

TEST_P(Puma560, RotorInertiaIsTheMotorTimesTheGearRatioSquared) {
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(robot.arm.links[i].rotor_inertia, set.rotor[i] * gears[i] * gears[i], 1e-12);
  }
}

TEST_P(Puma560, EveryLinkHasACollisionPart) {
  for (int link = -1; link < 6; ++link) {
    EXPECT_TRUE(std::any_of(robot.parts.begin(), robot.parts.end(), [link](const RobotPart& part) {
      return part.link == link;
    })) << link;
  }
  tinyxml2::XMLDocument xml;
  ASSERT_EQ(xml.LoadFile(set.file.c_str()), tinyxml2::XML_SUCCESS);
  for (auto* link = xml.RootElement()->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    EXPECT_TRUE(link->FirstChildElement("collision")) << link->Attribute("name");
  }
}

/// True if `p_WQ` is inside one of the parts of `link`.
bool covers(const Robot& robot, const Kinematics& kinematics, int link, const Vec3& p_WQ) {
  for (const RobotPart& part : robot.parts) {
    if (part.link != link) continue;
    const Vec3 p = (kinematics.X_WL(link) * part.X_LP).inverse() * p_WQ;
    const bool in_box = (p.cwiseAbs() - part.size).maxCoeff() <= 1e-9;
    const bool in_cylinder =
        p.head<2>().norm() <= part.size[0] + 1e-9 && std::abs(p.z()) <= part.size[1] + 1e-9;
    if (part.kind == PartKind::box ? in_box : in_cylinder) return true;
  }
  return false;
}

// In the ready pose the upper arm points straight up above the shoulder, the forearm above the
// elbow.
TEST_P(Puma560, PartsSpanTheLinksFromJointToJoint) {
  Kinematics kinematics(robot.arm);
  const Joints ready = {0, pi / 2, -pi / 2, 0, 0, 0};
  kinematics.update(set.modified ? to_modified(ready) : ready);
  const double elbow = 0.672 + 0.4318, wrist = elbow + (set.modified ? 0.4331 : 0.4318);
  for (const double z : {0.0, 0.3, 0.56}) {
    EXPECT_TRUE(covers(robot, kinematics, -1, Vec3(0, 0, z))) << "column at " << z;
  }
  for (const double y : {0.0, -0.1, -0.19}) {
    EXPECT_TRUE(covers(robot, kinematics, 0, Vec3(0, y, 0.672))) << "shoulder shaft at " << y;
  }
  for (const double z : {0.672 - 0.22, 0.672, 0.672 + 0.2, elbow, elbow + 0.07}) {
    EXPECT_TRUE(covers(robot, kinematics, 1, Vec3(0, -0.2435, z))) << "upper arm at " << z;
  }
  for (const double z : {elbow - 0.05, elbow, elbow + 0.2, elbow + 0.35}) {
    EXPECT_TRUE(covers(robot, kinematics, 2, Vec3(0.0203, -0.15, z))) << "forearm at " << z;
  }
  EXPECT_TRUE(covers(robot, kinematics, 3, Vec3(0.0203, -0.15, wrist - 0.05))) << "wrist box";
  EXPECT_TRUE(covers(robot, kinematics, 4, Vec3(0.0203, -0.15, wrist))) << "joint 5";
  EXPECT_TRUE(covers(robot, kinematics, 5, Vec3(0.0203, -0.15, wrist + 0.053))) << "flange";
}

TEST(Puma560Sets, JointFrictionIsTheMotorFrictionThroughTheGear) {
  constexpr Joints viscous = {1.48e-3, .817e-3, 1.38e-3, 71.2e-6, 82.6e-6, 36.7e-6};
  const ArmModel standard = load_arm("robots/puma560.urdf").arm;
  const ArmModel armstrong = load_arm("robots/puma560_armstrong.urdf").arm;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(standard.links[i].viscous_friction, viscous[i] * gears[i] * gears[i], 1e-8);
    EXPECT_GT(standard.links[i].coulomb_friction, 0.0);
    EXPECT_EQ(armstrong.links[i].viscous_friction, 0.0) << "that set publishes none";
    EXPECT_EQ(armstrong.links[i].coulomb_friction, 0.0) << "that set publishes none";
  }
}

// The lengths differ by 1.3 mm in the forearm and 0.05 mm at the shoulder.
TEST(Puma560Sets, DescribeOneMachineWithinTwoMillimetres) {
  const ArmModel arm = load_arm("robots/puma560.urdf").arm;
  Kinematics standard(arm), armstrong(load_arm("robots/puma560_armstrong.urdf").arm);
  std::mt19937_64 random(seed);
  for (int sample = 0; sample < 200; ++sample) {
    const auto drawn = test::random_joints(arm, random);
    Joints q;
    std::copy(drawn.begin(), drawn.end(), q.begin());
    standard.update(q);
    armstrong.update(to_modified(q));
    const Pose X = standard.X_WT().inverse() * armstrong.X_WT();
    EXPECT_LT(X.translation().norm(), 2e-3) << "seed " << seed;
    EXPECT_LT((X.linear() - Mat3::Identity()).norm(), 1e-12) << "seed " << seed;
  }
}

// P. Corke, Robotics, Vision and Control: fkine and gravload of the standard set.
TEST(Puma560Sets, StandardSetReproducesTheToolboxResults) {
  ArmModel arm = load_arm("robots/puma560.urdf").arm;
  Kinematics kinematics(arm);
  kinematics.update(Joints{0, pi / 4, pi, 0, pi / 4, 0});
  const Vec3 wrist = kinematics.X_WL(5).translation() - Vec3(0, 0, 0.672);
  EXPECT_LT((wrist - Vec3(0.5963, -0.1501, -0.0144)).norm(), 2e-4);

  const auto nominal = gravity_of("robots/puma560.urdf", {0, pi / 4, pi, 0, pi / 4, 0}, 9.81);
  EXPECT_NEAR(nominal[0], 0.0, 1e-9);
  EXPECT_NEAR(nominal[1], 31.6399, 1e-4);
  EXPECT_NEAR(nominal[2], 6.0351, 1e-4);
  EXPECT_NEAR(nominal[4], 0.0283, 1e-4);
  const auto stretched = gravity_of("robots/puma560.urdf", {0, 0, -pi / 2, 0, 0, 0}, 9.81);
  EXPECT_NEAR(stretched[1], 46.0069, 1e-4);
  EXPECT_NEAR(stretched[2], 8.7722, 1e-4);
}

// Armstrong, Khatib and Burdick's gravity constants, three digits each.
TEST(Puma560Sets, ArmstrongSetReproducesThePublishedGravityTerms) {
  constexpr double g1 = -37.2, g2 = -8.44, g3 = 1.02, g4 = 0.249, g5 = -0.0282;
  std::mt19937_64 random(seed);
  const ArmModel arm = load_arm("robots/puma560_armstrong.urdf").arm;
  for (int sample = 0; sample < 50; ++sample) {
    const auto q = test::random_joints(arm, random);
    const double s2 = std::sin(q[1]), c2 = std::cos(q[1]), s23 = std::sin(q[1] + q[2]),
                 c23 = std::cos(q[1] + q[2]), s4 = std::sin(q[3]), c4 = std::cos(q[3]),
                 s5 = std::sin(q[4]), c5 = std::cos(q[4]);
    const double forearm = g2 * s23 + g4 * c23 + g5 * (s23 * c5 + c23 * c4 * s5);
    const auto torques =
        gravity_of("robots/puma560_armstrong.urdf", {q[0], q[1], q[2], q[3], q[4], q[5]}, 9.8);
    EXPECT_NEAR(torques[0], 0.0, 1e-9) << "seed " << seed;
    EXPECT_NEAR(torques[1], g1 * c2 + g3 * s2 + forearm, 0.02) << "seed " << seed;
    EXPECT_NEAR(torques[2], forearm, 0.01) << "seed " << seed;
    EXPECT_NEAR(torques[3], -g5 * s23 * s4 * s5, 1e-4) << "seed " << seed;
    EXPECT_NEAR(torques[4], g5 * (c23 * s5 + s23 * c4 * c5), 1e-4) << "seed " << seed;
    EXPECT_NEAR(torques[5], 0.0, 1e-9) << "seed " << seed;
  }
}

}  // namespace puma560_test
}  // namespace repel
