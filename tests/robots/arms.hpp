// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arms used by these tests, and random joint positions for them.
#pragma once

#include <random>
#include <string>
#include <vector>

#include <repel/robots/kinematics.hpp>
#include <repel/robots/urdf.hpp>

namespace repel::test {

inline const std::vector<std::string> puma_files = {"robots/puma560.urdf",
                                                    "robots/puma560_armstrong.urdf"};

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

/// Both PUMA sets and the skewed arm.
inline std::vector<ArmModel> all_arms() {
  std::vector<ArmModel> arms = {skewed_arm()};
  for (const std::string& file : puma_files) arms.push_back(load_arm(file).arm);
  return arms;
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
