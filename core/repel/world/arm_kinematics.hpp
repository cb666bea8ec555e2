// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Interface of the kinematics and dynamics of an arm that the loop needs, for KDL, a formula of
/// your own, or a manufacturer's model.
#pragma once

#include <limits>
#include <span>

#include <Eigen/Core>

#include <repel/base/types.hpp>

namespace repel {

/// Six rows, linear then angular, world axes; a column for each joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
/// Binds to any 6 x n matrix stored by columns.
using JacobianRef = Eigen::Ref<Jacobian>;

/// All results refer to the joints of the last `update`. Functions must not throw, allocate or
/// block: they are called in the tick, some once per link. Joints that are not finite must give
/// results that are not finite, with no other effect.
class ArmKinematics {
 public:
  virtual ~ArmKinematics() = default;

  /// Joint positions [rad] or [m], one per link, base outward.
  virtual void update(std::span<const double> q) noexcept = 0;

  /// Pose of the tool frame in the world [m].
  [[nodiscard]] virtual Pose X_WT() const noexcept = 0;
  /// Jacobian of the origin of the tool frame.
  virtual void tool_jacobian(JacobianRef J) const noexcept = 0;
  /// The torques [N m] or forces [N] that balance gravity.
  virtual void gravity_torques(std::span<double> out) noexcept = 0;

  /// Pose of the frame of a link in the world [m]; used for links with parts, and for the inertia
  /// if there is no `mass_matrix`. If not overridden, the cell rejects link parts.
  [[nodiscard]] virtual Pose X_WL(int /*link*/) const noexcept {
    Pose unknown = Pose::Identity();
    for (int row = 0; row < 3; ++row) {
      unknown.data()[12 + row] = std::numeric_limits<double>::quiet_NaN();
    }
    return unknown;
  }
  /// Jacobian of the point Q fixed on `link`, now at `p_WQ` [m]; used as X_WL is.
  virtual void jacobian(int /*link*/, const Vec3& /*p_WQ*/, JacobianRef J) const noexcept {
    for (Eigen::Index column = 0; column < J.cols(); ++column) {
      for (Eigen::Index row = 0; row < 6; ++row) {
        J(row, column) = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  /// Writes the joint-space inertia matrix [kg m^2] or [kg], symmetric, rotors included, and
  /// returns true. False: not available, to be computed from the masses of the ArmModel.
  [[nodiscard]] virtual bool mass_matrix(Eigen::MatrixXd& /*M*/) const noexcept { return false; }

 protected:
  ArmKinematics() = default;
  ArmKinematics(const ArmKinematics&) = default;             ///< for what is derived from it
  ArmKinematics(ArmKinematics&&) = default;                  ///< for what is derived from it
  ArmKinematics& operator=(const ArmKinematics&) = default;  ///< for what is derived from it
  ArmKinematics& operator=(ArmKinematics&&) = default;       ///< for what is derived from it
};

}  // namespace repel
