// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Inverse poses, and rotations by angle and axis and between two others. Bitwise equal to those of
/// Eigen, but plain functions: including them compiles none of Eigen's expression types for parts
/// of a pose and their products.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <repel/base/types.hpp>

namespace repel {

/// X_BA for X_AB.
[[nodiscard]] inline Pose inverted(const Pose& X_AB) noexcept {
  const double* r = X_AB.data();
  Pose X_BA = X_AB;  // copies the last row
  for (std::size_t row = 0; row < 3; ++row) {
    const double* column = r + 4 * row;
    double* q = X_BA.data() + row;
    q[0] = column[0];
    q[4] = column[1];
    q[8] = column[2];
    // As Eigen sums: see `operator*` of a matrix.
    const double end = -column[1] * r[13];
    const double far = -column[2] * r[14];
    q[12] = row < 2 ? -column[0] * r[12] + end + far : -column[0] * r[12] + (end + far);
  }
  return X_BA;
}

/// The pose with this rotation, at this origin [m].
[[nodiscard]] inline Pose posed(const Mat3& R, const Vec3& p) noexcept {
  Pose X = Pose::Identity();
  for (int k = 0; k < 9; ++k) X.data()[k + k / 3] = R.data()[k];
  for (int k = 0; k < 3; ++k) X.data()[12 + k] = p[k];
  return X;
}

/// A rotation by an angle around an axis.
struct Turn {
  double angle = 0.0;  ///< [rad] 0 to pi
  Vec3 axis{1, 0, 0};  ///< unit
};

namespace detail {

/// x, y, z, w
using Quaternion = std::array<double, 4>;

/// The unit quaternion of the rotation `R` (Shoemake 1987).
[[nodiscard]] inline Quaternion quaternion_of(const Mat3& R) noexcept {
  const auto M = [&](std::size_t row, std::size_t column) { return R.data()[row + 3 * column]; };
  Quaternion q{};
  const double trace = M(0, 0) + (M(1, 1) + M(2, 2));
  if (trace > 0.0) {
    const double root = std::sqrt(trace + 1.0);
    const double scale = 0.5 / root;
    q[0] = (M(2, 1) - M(1, 2)) * scale;
    q[1] = (M(0, 2) - M(2, 0)) * scale;
    q[2] = (M(1, 0) - M(0, 1)) * scale;
    q[3] = 0.5 * root;
    return q;
  }
  std::size_t i = M(1, 1) > M(0, 0) ? 1 : 0;
  if (M(2, 2) > M(i, i)) i = 2;
  const std::size_t j = (i + 1) % 3;
  const std::size_t k = (j + 1) % 3;
  const double root = std::sqrt(M(i, i) - M(j, j) - M(k, k) + 1.0);
  const double scale = 0.5 / root;
  q[i] = 0.5 * root;
  q[j] = (M(j, i) + M(i, j)) * scale;
  q[k] = (M(k, i) + M(i, k)) * scale;
  q[3] = (M(k, j) - M(j, k)) * scale;
  return q;
}

/// The rotation of a unit quaternion.
[[nodiscard]] inline Mat3 matrix_of(const Quaternion& q) noexcept {
  const double tx = 2.0 * q[0], ty = 2.0 * q[1], tz = 2.0 * q[2];
  const double twx = tx * q[3], twy = ty * q[3], twz = tz * q[3];
  const double txx = tx * q[0], txy = ty * q[0], txz = tz * q[0];
  const double tyy = ty * q[1], tyz = tz * q[1], tzz = tz * q[2];
  Mat3 R;
  double* r = R.data();
  r[0] = 1.0 - (tyy + tzz);
  r[1] = txy + twz;
  r[2] = txz - twy;
  r[3] = txy - twz;
  r[4] = 1.0 - (txx + tzz);
  r[5] = tyz + twx;
  r[6] = txz + twy;
  r[7] = tyz - twx;
  r[8] = 1.0 - (txx + tyy);
  return R;
}

}  // namespace detail

/// Angle and axis of the rotation `R`; of none, the x axis.
[[nodiscard]] inline Turn turn_of(const Mat3& R) noexcept {
  const detail::Quaternion q = detail::quaternion_of(R);
  const Vec3 v(q[0], q[1], q[2]);
  double sine = norm(v);  // of half the angle
  if (sine < std::numeric_limits<double>::epsilon()) {
    const double scale = largest_entry(v);
    if (!(scale > 0.0)) return {};
    sine = scale * norm(v * (1.0 / scale));  // its square might underflow
  }
  const double angle = 2.0 * std::atan2(sine, std::abs(q[3]));
  return {angle, v / (q[3] < 0.0 ? -sine : sine)};
}

/// The rotation after a share of the even turn from one to another, on the shorter way.
/// @param share 0 to 1
[[nodiscard]] inline Mat3 between(const Mat3& from, const Mat3& to, double share) noexcept {
  const detail::Quaternion a = detail::quaternion_of(from);
  const detail::Quaternion b = detail::quaternion_of(to);
  const double cosine = (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3]);
  double of_a = 1.0 - share;
  double of_b = share;
  if (!(std::abs(cosine) >= 1.0 - std::numeric_limits<double>::epsilon())) {
    const double angle = std::acos(std::abs(cosine));
    const double sine = std::sin(angle);
    of_a = std::sin((1.0 - share) * angle) / sine;
    of_b = std::sin(share * angle) / sine;
  }
  if (cosine < 0.0) of_b = -of_b;
  detail::Quaternion q{};
  for (std::size_t i = 0; i < 4; ++i) q[i] = of_a * a[i] + of_b * b[i];
  return detail::matrix_of(q);
}

}  // namespace repel
