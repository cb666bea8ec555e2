/// @file
/// Where the links of an arm are, how they move, and the torque that carries their weight.
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Six rows, one column per link: the linear velocity of a point, then the angular velocity of its
/// link, per unit of joint velocity. Binds to a 6 x n matrix of fixed or dynamic size.
using JacobianRef = Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>;

/// Forward kinematics, Jacobians and gravity torques of one arm. After construction nothing here
/// allocates, locks or throws. It holds its state: use one per thread.
///
/// Spans have one entry per link, base outward. Angles that are not finite give poses, Jacobians
/// and torques that are not finite.
class Kinematics {
 public:
  /// All joints start at zero. Throws SetupError when `arm` has no link or a value is not finite.
  explicit Kinematics(const ArmModel& arm);
  Kinematics(Kinematics&&) noexcept;
  Kinematics& operator=(Kinematics&&) noexcept;
  ~Kinematics();

  /// The number of moving links.
  [[nodiscard]] int links() const noexcept;

  /// Moves the arm to joint positions `q` [rad] or [m]; all else here answers for this pose.
  void update(std::span<const double> q) noexcept;

  /// Pose of a link in the world [m]; of the base for -1.
  [[nodiscard]] const Pose& X_WL(int link) const noexcept;

  /// Pose of the tool frame in the world [m].
  [[nodiscard]] const Pose& X_WT() const noexcept;

  /// Jacobian of the point Q fixed on `link` (-1: the base), now at `p_WQ` [m]; world axes.
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept;

  /// Jacobian of the origin of the tool frame; world axes.
  void tool_jacobian(JacobianRef J) const noexcept;

  /// The torques [N m] or forces [N] that hold the arm still against gravity.
  void gravity_torques(std::span<double> out) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel
