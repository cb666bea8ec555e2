// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A controller for three rails and a wall.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "repel_controller.hpp"

namespace adapters {

/// Its tool is at (x, y, z). The drives do not know of the weight.
struct GantryKinematics final : repel::ArmKinematics {
  void update(std::span<const double> q) noexcept override { p = {q[0], q[1], q[2]}; }
  repel::Pose X_WT() const noexcept override { return repel::Pose(Eigen::Translation3d(p)); }
  void tool_jacobian(repel::JacobianRef J) const noexcept override { J.setIdentity(); }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
    out[2] = 4.0 * 9.81;  // [N]
  }
  repel::Vec3 p{0, 0, 0};
};

class GantryController : public RepelController {
 protected:
  repel::CellDescription describe() const override {
    repel::CellDescription cell;
    repel::ArmDescription& arm = cell.arms.emplace_back();
    for (const char* rail : {"x", "y", "z"}) {
      repel::ArmLink& link = arm.model.links.emplace_back();
      link.joint_name = rail;
      link.type = repel::JointType::prismatic;
      link.lower = -1.0, link.upper = 1.0;  // [m]
      link.viscous_friction = 300.0;        // [N s/m]
      link.rotor_inertia = 4.0;             // [kg]
    }
    arm.kinematics = std::make_unique<GantryKinematics>();
    arm.options.has_brakes = true;  // they engage when the controller is deactivated
    arm.parts.push_back({"ball", repel::Shape::sphere(0.05)});
    const repel::Pose X_WP(Eigen::Translation3d(0.35, 0.0, 0.0));
    cell.obstacles.push_back({"wall", repel::Shape::box({0.1, 1.0, 1.0}), X_WP});
    return cell;
  }
};

}  // namespace adapters
