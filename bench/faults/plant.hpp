// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm whose drive can be spoilt, and where its parts truly are.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <repel/robots/dynamics.hpp>
#include <repel/runs/faults/exchange.hpp>
#include <repel/world/arm.hpp>

namespace repel::faults {

/// The joints of an arm in time: M a = tau - c - D v, and dry friction and brakes that hold a joint
/// still. M and c, by KDL, hold for one `step`.
class Plant {
 public:
  static constexpr int substeps = 10;  ///< of one step

  /// @throws SetupError as Dynamics
  explicit Plant(ArmModel model);
  /// Puts it at rest at `q` [rad] or [m].
  void reset(std::span<const double> q);
  /// Moves by `period` [s]. @param braked no torque acts, and brakes are on
  void step(double period, std::span<const DriveOfJoint> drive, bool braked);

  [[nodiscard]] const std::vector<double>& q() const { return q_; }  ///< [rad] or [m]
  [[nodiscard]] const std::vector<double>& v() const { return v_; }  ///< [rad/s] or [m/s]
  [[nodiscard]] const ArmModel& model() const { return model_; }     ///< that it obeys

 private:
  ArmModel model_;
  Dynamics dynamics_;
  std::vector<double> q_, v_, bias_;
  Eigen::MatrixXd M_, mobility_;
  Eigen::VectorXd held_;  // [N m s] impulses of dry friction and brakes in the last substep
};

/// Points P of a link that are the corners of a part, or the middle of a ball.
struct Points {
  int link = 0;            ///< index in ArmModel::links
  std::vector<Vec3> p_LP;  ///< [m]
  double radius = 0.0;     ///< [m] about each
};

/// Where an arm truly is: by a product of its joints' transformations, apart from the library.
class Truth {
 public:
  /// @param wall its half extents [m] and the pose of its middle
  Truth(const ArmModel& model, std::vector<Points> parts)
      : model_(model), parts_(std::move(parts)) {}
  /// The box that is the wall: pose of its middle, half extents [m].
  void set_wall(const Pose& X_WB, const Vec3& half) { X_BW_ = X_WB.inverse(), half_ = half; }
  /// [m] Signed distance from the wall of what is nearest to it, below zero inside.
  [[nodiscard]] double gap(std::span<const double> q) const;
  /// [m] Origin of the tool.
  [[nodiscard]] Vec3 tool(std::span<const double> q) const;

 private:
  [[nodiscard]] std::vector<Pose> links(std::span<const double> q) const;
  ArmModel model_;
  std::vector<Points> parts_;
  Pose X_BW_ = Pose::Identity();
  Vec3 half_{0, 0, 0};
};

}  // namespace repel::faults
