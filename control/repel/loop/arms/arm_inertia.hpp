// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The joint-space inertia of an arm, from its links at their present poses.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <repel/network/elements/dense.hpp>
#include <repel/network/elements/port.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// Effort limit of a joint [N m] or [N], finite. If the model has none: twice the gravity load plus
/// 50 rad/s^2 (m/s^2) times the moved inertia, both with the arm stretched out, and at least 200 N
/// m or 1000 N. Not for the tick.
[[nodiscard]] double effort_bound(const ArmModel& model, std::size_t joint);

/// The same for all joints.
[[nodiscard]] std::vector<double> effort_bounds(const ArmModel& model);

/// Error message for an arm with an unsound `ArmInertia` at its start.
inline constexpr const char* unsound_mass =
    "its mass matrix at the start is none; allowed: a finite, symmetric and positive definite one";

/// The inertia matrix of an arm at its joints,
///
///     M = sum over the links of  m Jv' Jv + Jw' I Jw     and the rotors on the diagonal
///
/// with Jv that of the centre of mass; or the mass matrix of the kinematics. A joint without mass
/// at this pose (`missing`) gets its effort / 100 rad/s^2 (m/s^2) as inertia. Allocates at
/// construction only.
class ArmInertia {
 public:
  using Vector = network::Vec<network::any_size>;  ///< one entry for each joint
  using Matrix = network::Mat<network::any_size>;  ///< square, one row for each joint

  /// Allocates for the joints of `model`.
  explicit ArmInertia(const ArmModel& model);

  /// Updates M to the pose of `kinematics`. Cost: a Jacobian for each link, or its mass matrix, and
  /// a factorization.
  /// @return whether it can be a mass matrix: finite, symmetric, nowhere negative, its inertias
  /// between a fourth and four times the last ones; else M stays
  [[nodiscard]] bool update(const ArmKinematics& kinematics) noexcept;
  /// Accepts the next sound matrix whatever the last one was: the arm moved on unseen.
  void begin_anew() noexcept { is_known_ = false; }

  /// M [kg m^2] or [kg], symmetric.
  [[nodiscard]] const Matrix& matrix() const noexcept { return M_; }

  /// The first joint with no mass or a NaN at the last update; -1: none.
  [[nodiscard]] int missing() const noexcept { return missing_; }

  /// Momenta M v [kg m^2/s] or [kg m/s].
  void momenta(std::span<const double> v, Vector& out) const noexcept;

 private:
  [[nodiscard]] Eigen::Index size() const noexcept;

  // Whether the inertias can follow the last ones a moment later. Below a tenth of the substitute
  // for an unknown inertia anything is accepted.
  [[nodiscard]] bool follows() const noexcept;

  [[nodiscard]] bool is_sound() noexcept;

  void add_links(const ArmKinematics& kinematics) noexcept;

  // Adds a link to the upper triangle.
  void add(const ArmKinematics& kinematics, const ArmLink& link, int index) noexcept;

  const ArmModel& model_;
  Jacobian drawn_;
  Eigen::MatrixXd given_;
  Matrix M_, next_;
  network::dense::Factored factored_;
  std::vector<double> nominal_;  // [kg m^2] or [kg]
  int missing_ = -1;
  bool is_known_ = false;
};

}  // namespace repel
