// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A UR5e as repel sees it: where its joints are, and their limits.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/world/kinematics.hpp>

namespace adapters {

/// The arm from the maker's table of Denavit-Hartenberg parameters ("DH parameters for calculations
/// of kinematics and dynamics"), in its base frame; the tool frame is the flange. Your own arm
/// differs by its calibration, up to some millimetres. Efforts are those of the maker's robot
/// description. Other arms of the maker have the same table with other numbers.
/// @param q where it starts [rad] @param most_rate [rad/s] of a joint; the arm itself allows pi.
///   While something blocks the arm, its command runs ahead by what it covers at this rate within
///   its response.
[[nodiscard]] inline repel::ArmDescription ur5e(const std::vector<double>& q,
                                                double most_rate = 0.5) {
  constexpr double d[] = {0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996};  // [m]
  constexpr double a[] = {0.0, -0.425, -0.3922, 0.0, 0.0, 0.0};       // [m]
  constexpr double alpha[] = {M_PI / 2, 0.0, 0.0, M_PI / 2, -M_PI / 2, 0.0};
  repel::ArmDescription arm;
  repel::Pose X_PJ = repel::Pose::Identity();
  for (int i = 0; i < 6; ++i) {
    repel::ArmLink& link = arm.model.links.emplace_back();
    link.X_PJ = X_PJ;
    link.lower = i == 2 ? -M_PI : -2.0 * M_PI;
    link.upper = -link.lower;
    link.velocity_limit = most_rate;
    link.effort_limit = i < 3 ? 150.0 : 28.0;  // [N m]
    X_PJ =
        Eigen::Translation3d(a[i], 0.0, d[i]) * Eigen::AngleAxisd(alpha[i], repel::Vec3::UnitX());
  }
  arm.model.X_LT = X_PJ;
  arm.kinematics = std::make_unique<repel::Kinematics>(arm.model);
  arm.start = q;
  return arm;
}

}  // namespace adapters
