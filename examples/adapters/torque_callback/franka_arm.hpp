// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arm of libfranka as repel sees it: kinematics and limits.
#pragma once

#include <algorithm>
#include <array>

#include <franka/model.h>
#include <franka/robot.h>

#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

#include "franka_limits.hpp"

namespace adapters {

/// The model library of the robot as kinematics; the world is its base frame O.
class FrankaKinematics final : public repel::ArmKinematics {
 public:
  /// @param state whose end effector and load hold for as long as this is used
  FrankaKinematics(const franka::Model& model, const franka::RobotState& state)
      : model_(model), state_(state) {}

  void update(std::span<const double> q) noexcept override {
    std::copy(q.begin(), q.end(), state_.q.begin());
  }
  repel::Pose X_WT() const noexcept override { return pose(franka::Frame::kEndEffector); }
  void tool_jacobian(repel::JacobianRef J) const noexcept override {
    fill(franka::Frame::kEndEffector, J);
  }
  // The robot holds its own weight.
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }
  bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    const std::array<double, 49> mass = model_.mass(state_);
    M = Eigen::Map<const Eigen::Matrix<double, 7, 7>>(mass.data());
    return true;
  }
  repel::Pose X_WL(int link) const noexcept override { return pose(franka::Frame(link)); }
  void jacobian(int link, const repel::Vec3& p_WQ, repel::JacobianRef J) const noexcept override {
    fill(franka::Frame(link), J);
    const repel::Vec3 arm = p_WQ - X_WL(link).translation();
    for (int i = 0; i < 7; ++i) J.col(i).head<3>() += J.col(i).tail<3>().cross(arm);
  }

 private:
  [[nodiscard]] repel::Pose pose(franka::Frame frame) const noexcept {
    const std::array<double, 16> X = model_.pose(frame, state_);
    return repel::Pose(Eigen::Map<const Eigen::Matrix4d>(X.data()));
  }
  void fill(franka::Frame frame, repel::JacobianRef J) const noexcept {
    const std::array<double, 42> columns = model_.zeroJacobian(frame, state_);
    J = Eigen::Map<const Eigen::Matrix<double, 6, 7>>(columns.data());
  }

  const franka::Model& model_;
  franka::RobotState state_;
};

/// The model for FrankaKinematics: limits alone, as masses and poses come from the robot.
inline repel::ArmModel franka_model(const FrankaLimits& limits) {
  repel::ArmModel arm;
  arm.links.resize(7);
  limit(arm, limits);
  return arm;
}

}  // namespace adapters
