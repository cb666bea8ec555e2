// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Twist and wrench as named linear and angular parts, and their transformation between points and
/// frames.
#pragma once

#include <repel/base/types.hpp>

namespace repel {

/// Velocity of a rigid body: the linear velocity of a stated reference point and the angular
/// velocity.
struct Twist {
  Vec3 linear{0, 0, 0};   ///< [m/s] velocity of the reference point
  Vec3 angular{0, 0, 0};  ///< [rad/s]

  /// Adds in place, part by part.
  Twist& operator+=(const Twist& other) noexcept {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
};

/// Force and torque on a rigid body about a stated reference point.
struct Wrench {
  Vec3 force{0, 0, 0};   ///< [N]
  Vec3 torque{0, 0, 0};  ///< [N m] about the reference point

  /// Adds in place, part by part; about the same point.
  Wrench& operator+=(const Wrench& other) noexcept {
    force += other.force;
    torque += other.torque;
    return *this;
  }
};

/// Sum of two twists of one point.
[[nodiscard]] inline Twist operator+(Twist a, const Twist& b) noexcept {
  return a += b;
}
/// Sum of two wrenches about one point.
[[nodiscard]] inline Wrench operator+(Wrench a, const Wrench& b) noexcept {
  return a += b;
}

/// Both parts times `scale`.
[[nodiscard]] inline Twist operator*(double scale, const Twist& V) noexcept {
  return {scale * V.linear, scale * V.angular};
}
/// Both parts times `scale`.
[[nodiscard]] inline Wrench operator*(double scale, const Wrench& F) noexcept {
  return {scale * F.force, scale * F.torque};
}

/// Power that `F` delivers to a body moving with `V` [W]. Both in one frame, about one point.
[[nodiscard]] inline double power(const Wrench& F, const Twist& V) noexcept {
  return dot(F.force, V.linear) + dot(F.torque, V.angular);
}

/// The wrench about point P of a force `f_W` [N] at point Q; `p_PQ_W` [m] from P to Q.
[[nodiscard]] inline Wrench wrench_of_force(const Vec3& f_W, const Vec3& p_PQ_W) noexcept {
  return {f_W, p_PQ_W.cross(f_W)};
}

/// The same wrench about Q instead of P; `p_PQ_W` [m] from P to Q.
[[nodiscard]] inline Wrench moved_to(const Wrench& F_P_W, const Vec3& p_PQ_W) noexcept {
  return {F_P_W.force, F_P_W.torque - p_PQ_W.cross(F_P_W.force)};
}

/// The same motion at reference point Q instead of P, both fixed in the body; `p_PQ_W` [m] from P
/// to Q.
[[nodiscard]] inline Twist moved_to(const Twist& V_P_W, const Vec3& p_PQ_W) noexcept {
  return {V_P_W.linear + V_P_W.angular.cross(p_PQ_W), V_P_W.angular};
}

/// The wrench expressed in A instead of B, about the same point.
[[nodiscard]] inline Wrench rotated(const Mat3& R_AB, const Wrench& F_B) noexcept {
  return {R_AB * F_B.force, R_AB * F_B.torque};
}

/// The twist expressed in A instead of B, about the same point.
[[nodiscard]] inline Twist rotated(const Mat3& R_AB, const Twist& V_B) noexcept {
  return {R_AB * V_B.linear, R_AB * V_B.angular};
}

/// No entry is infinite or not a number.
[[nodiscard]] inline bool is_finite(const Wrench& F) noexcept {
  return is_finite(F.force) && is_finite(F.torque);
}
/// No entry is infinite or not a number.
[[nodiscard]] inline bool is_finite(const Twist& V) noexcept {
  return is_finite(V.linear) && is_finite(V.angular);
}

}  // namespace repel
