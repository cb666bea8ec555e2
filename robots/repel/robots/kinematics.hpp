// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Forward kinematics, Jacobians, gravity compensation and inertia of an arm.
#pragma once

#include <memory>
#include <span>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// Forward kinematics, Jacobians, gravity torques and inertia of one arm, in closed form: `update`
/// places every link once, all else is read off these poses. After construction nothing here
/// allocates, locks or throws. Not thread-safe: use one instance per thread.
///
/// Spans have one entry per link, base outward. Joint positions that are not finite give poses,
/// Jacobians and torques that are not finite.
class Kinematics final : public ArmKinematics {
 public:
  /// All joints start at zero.
  /// @throws SetupError if `arm` has no link or a value is not finite
  explicit Kinematics(const ArmModel& arm);
  /// Moves; the other may then only be assigned to or destroyed.
  Kinematics(Kinematics&&) noexcept;
  /// Moves; the other may then only be assigned to or destroyed.
  Kinematics& operator=(Kinematics&&) noexcept;
  ~Kinematics() override;

  /// The number of moving links.
  [[nodiscard]] int links() const noexcept;

  /// Sets the joint positions `q` [rad] or [m]; all other functions refer to this pose.
  void update(std::span<const double> q) noexcept override;

  /// Pose of a link in the world [m]; of the base for -1.
  [[nodiscard]] Pose X_WL(int link) const noexcept override;

  /// Pose of the tool frame in the world [m].
  [[nodiscard]] Pose X_WT() const noexcept override;

  /// Jacobian of the point Q fixed on `link` (-1: the base), currently at `p_WQ` [m]; world axes.
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override;

  /// Jacobian of the origin of the tool frame; world axes.
  void tool_jacobian(JacobianRef J) const noexcept override;

  /// The torques [N m] or forces [N] that hold the arm still against gravity.
  void gravity_torques(std::span<double> out) noexcept override;

  /// The joint-space inertia matrix [kg m^2] or [kg], rotors included. Allocates unless `M` has the
  /// size of the arm. @return true
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel
