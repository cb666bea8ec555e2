// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms of links, without a file, and random joint positions for them.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <repel/world/arm.hpp>

namespace repel::test {

/// An arm with a prismatic joint, skew axes, and base and tool away from the origin.
inline ArmModel skewed_arm() {
  const Pose tilt(Eigen::Translation3d(0.1, -0.2, 0.3) *
                  Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -1.0).normalized()));
  ArmModel arm;
  arm.name = "skewed";
  arm.X_WB = tilt;
  arm.X_LT = tilt;
  for (const Vec3& axis : {Vec3(1.0, 1.0, 0.0), Vec3(0.0, 0.5, 1.0), Vec3(1.0, 0.0, -2.0)}) {
    ArmLink link;
    link.name = "link_" + std::to_string(arm.links.size());
    link.type = arm.links.size() == 1 ? JointType::prismatic : JointType::revolute;
    link.X_PJ = tilt;
    link.axis_J = axis.normalized();
    link.mass = 1.0 + static_cast<double>(arm.links.size());
    link.p_LC = Vec3(0.05, 0.02, -0.1);
    link.I_C_L = Vec3(0.01, 0.02, 0.03).asDiagonal();
    link.lower = -1.0;
    link.upper = 1.0;
    arm.links.push_back(link);
  }
  return arm;
}

/// Six joints as of a PUMA 560, by modified Denavit-Hartenberg parameters, with a rotor in each.
inline ArmModel six_joint_arm() {
  struct Row {
    double alpha, a, d;  // [rad], [m], [m]
  };
  constexpr double right = 0.5 * std::numbers::pi;
  constexpr std::array<Row, 6> rows{{{0.0, 0.0, 0.67},
                                     {-right, 0.0, 0.24},
                                     {0.0, 0.43, -0.09},
                                     {right, -0.02, 0.43},
                                     {-right, 0.0, 0.0},
                                     {right, 0.0, 0.0}}};
  ArmModel arm;
  arm.name = "six joints";
  arm.X_LT = Pose(Eigen::Translation3d(0.0, 0.0, 0.06));
  for (const Row& row : rows) {
    const auto n = static_cast<double>(arm.links.size());
    ArmLink link;
    link.name = "link_" + std::to_string(arm.links.size());
    link.joint_name = "joint_" + std::to_string(arm.links.size());
    link.X_PJ =
        Pose(Eigen::AngleAxisd(row.alpha, Vec3::UnitX()) * Eigen::Translation3d(row.a, 0.0, row.d));
    link.mass = 12.0 / (1.0 + n);
    link.p_LC = Vec3(0.1 - 0.02 * n, 0.01, 0.05);
    link.I_C_L = (Vec3(0.1, 0.2, 0.15) / (1.0 + n)).asDiagonal();
    link.I_C_L(0, 1) = link.I_C_L(1, 0) = 0.01 / (1.0 + n);
    link.rotor_inertia = 0.3 / (1.0 + n);
    link.lower = -2.5;
    link.upper = 2.5;
    arm.links.push_back(link);
  }
  return arm;
}

/// Joint positions drawn uniformly between the limits.
inline std::vector<double> random_joints(const ArmModel& arm, std::mt19937_64& random) {
  std::vector<double> q;
  for (const ArmLink& link : arm.links) {
    q.push_back(std::uniform_real_distribution<double>(link.lower, link.upper)(random));
  }
  return q;
}

}  // namespace repel::test
