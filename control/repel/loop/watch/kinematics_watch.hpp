// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Plausibility check of what the kinematics of an arm answer.
#pragma once

#include <span>
#include <vector>

#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// Compares poses, Jacobians and gravity torques with those of a reference, the last ones that were
/// believed about 1 mrad (1 mm) of joint motion ago:
///
/// - all numbers are finite;
/// - the pose moves by the mean of both Jacobians times the motion of the joints, within 5 %;
/// - a Jacobian changes no faster than the motion of the joints can turn it;
/// - gravity torques are within twice the efforts, and change no faster than the motion of the
///   joints can change them.
///
/// The base of an arm does not move. Allocates at construction only. Cost: a pass over the
/// Jacobian.
class KinematicsWatch {
 public:
  /// @param efforts [N m] limits of the joints, finite
  explicit KinematicsWatch(std::vector<double> efforts);

  /// Whether a pose and the Jacobian of its origin can be those at `q` [rad].
  [[nodiscard]] bool agrees(std::span<const double> q, const Pose& X_WT,
                            const Jacobian& J) const noexcept;

  /// Makes them the reference if the joints have moved since the last one.
  void keep(std::span<const double> q, const Pose& X_WT, const Jacobian& J) noexcept;

  /// Whether `gravity` [N m] can be the torques that carry the weight at `q` [rad]; keeps them if
  /// so, else puts the last believed ones in their place.
  [[nodiscard]] bool believe(std::span<const double> q, std::span<double> gravity) noexcept;

 private:
  static constexpr double most_entry = 1e6;       // [m/rad]
  static constexpr double jacobian_noise = 1e-3;  // [m/rad]
  static constexpr double pose_noise = 2e-6;      // [m] and [rad]: numbers of single precision
  static constexpr double share = 0.05;           // of the way
  static constexpr double apart = 1e-3;           // [rad] to the reference
  static constexpr double far = 0.5;              // [rad]

  [[nodiscard]] static double way_to(std::span<const double> q,
                                     const std::vector<double>& from) noexcept;

  std::vector<double> efforts_;
  std::vector<double> q_;  // of the reference
  Pose X_WT_ = Pose::Identity();
  Jacobian J_;
  std::vector<double> gravity_, gravity_q_;
  bool is_known_ = false, has_gravity_ = false;
};

}  // namespace repel
