// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vector and pose types that all folders share, in SI units.
///
/// Frames are part of a name: `X_WB` is the pose of B in W, `p_WQ` the position of Q from the
/// origin of W, `n_AB_W` a direction from A to B expressed in W.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>

#include <Eigen/Geometry>

namespace repel {

using Vec3 = Eigen::Vector3d;    ///< a point, vector or force; world axes where its name ends in _W
using Mat3 = Eigen::Matrix3d;    ///< a rotation R_AB or a matrix of inertia; by columns
using Pose = Eigen::Isometry3d;  ///< a pose X_AB of B in A: rotation and position [m]

// Sums and multiples of vectors, evaluated at once: Eigen creates a type for each expression, and
// these types dominate the compile time. A template allows no conversions, so that all other
// expressions remain those of Eigen.
/// Sum, entry by entry.
template <std::same_as<Vec3> V>
[[nodiscard]] V operator+(const V& a, const V& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
/// Difference, entry by entry.
template <std::same_as<Vec3> V>
[[nodiscard]] V operator-(const V& a, const V& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// Negative, entry by entry.
template <std::same_as<Vec3> V>
[[nodiscard]] V operator-(const V& a) noexcept {
  return {-a[0], -a[1], -a[2]};
}
/// Multiple, entry by entry.
template <std::same_as<double> S, std::same_as<Vec3> V>
[[nodiscard]] V operator*(S s, const V& a) noexcept {
  return {s * a[0], s * a[1], s * a[2]};
}
/// Multiple, entry by entry.
template <std::same_as<double> S, std::same_as<Vec3> V>
[[nodiscard]] V operator*(const V& a, S s) noexcept {
  return {a[0] * s, a[1] * s, a[2] * s};
}
/// Quotient, entry by entry.
template <std::same_as<double> S, std::same_as<Vec3> V>
[[nodiscard]] V operator/(const V& a, S s) noexcept {
  return {a[0] / s, a[1] / s, a[2] / s};
}

// The third row is summed from its end, as Eigen does: the results are bitwise the same.
/// Product of a 3 x 3 matrix and a vector.
template <std::same_as<Mat3> M, std::same_as<Vec3> V>
[[nodiscard]] V operator*(const M& R, const V& v) noexcept {
  const double* r = R.data();
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + (r[5] * v[1] + r[8] * v[2])};
}
/// Product of two 3 x 3 matrices.
template <std::same_as<Mat3> M>
[[nodiscard]] M operator*(const M& a, const M& b) noexcept {
  M product;
  const double* r = a.data();
  for (int column = 0; column < 3; ++column) {
    const double* c = b.data() + 3 * column;
    double* p = product.data() + 3 * column;
    p[0] = r[0] * c[0] + r[3] * c[1] + r[6] * c[2];
    p[1] = r[1] * c[0] + r[4] * c[1] + r[7] * c[2];
    p[2] = r[2] * c[0] + (r[5] * c[1] + r[8] * c[2]);
  }
  return product;
}
/// The point p of B in A.
template <std::same_as<Pose> X, std::same_as<Vec3> V>
[[nodiscard]] V operator*(const X& X_AB, const V& p) noexcept {
  const double* r = X_AB.data();
  return {r[0] * p[0] + r[4] * p[1] + r[8] * p[2] + r[12],
          r[1] * p[0] + r[5] * p[1] + r[9] * p[2] + r[13],
          r[2] * p[0] + r[6] * p[1] + r[10] * p[2] + r[14]};
}

/// The functions of Eigen's names, bitwise equal to them: sums run from the first entry.
template <std::same_as<Vec3> V>
[[nodiscard]] double dot(const V& a, const V& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// Sum of squares.
template <std::same_as<Vec3> V>
[[nodiscard]] double squared_norm(const V& v) noexcept {
  return dot(v, v);
}
/// Euclidean length.
template <std::same_as<Vec3> V>
[[nodiscard]] double norm(const V& v) noexcept {
  return std::sqrt(dot(v, v));
}
/// `v` itself when it is zero.
template <std::same_as<Vec3> V>
[[nodiscard]] V normalized(const V& v) noexcept {
  const double square = dot(v, v);
  return square > 0.0 ? v / std::sqrt(square) : v;
}

/// Equal in every entry.
[[nodiscard]] inline bool is_same(const Vec3& a, const Vec3& b) noexcept {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// The unit vector along axis 0, 1 or 2.
[[nodiscard]] inline Vec3 unit(int axis) noexcept {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

/// The largest magnitude of an entry of `v`.
[[nodiscard]] inline double largest_entry(const Vec3& v) noexcept {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

/// `v` normalized, without overflow or underflow; `v` itself when it is zero.
[[nodiscard]] inline Vec3 direction_of(const Vec3& v) noexcept {
  const double scale = largest_entry(v);
  const double square = squared_norm(v / scale);
  return square > 0.0 ? v / (std::sqrt(square) * scale) : v;
}

/// A unit vector perpendicular to the unit vector `n`.
[[nodiscard]] inline Vec3 perpendicular_to(const Vec3& n) noexcept {
  int least = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(n[axis]) < std::abs(n[least])) least = axis;
  }
  return direction_of(n.cross(unit(least)));
}

/// The origin of B in A [m] for X_AB, as a plain vector.
[[nodiscard]] inline Vec3 origin(const Pose& X) noexcept {
  const double* p = X.data() + 12;
  return {p[0], p[1], p[2]};
}

/// The rotation of `X`, as a plain matrix.
[[nodiscard]] inline Mat3 rotation(const Pose& X) noexcept {
  Mat3 R;
  for (int k = 0; k < 9; ++k) R.data()[k] = X.data()[k + k / 3];
  return R;
}

/// The transpose; of a rotation, its inverse.
[[nodiscard]] inline Mat3 transposed(const Mat3& R) noexcept {
  Mat3 turned;
  for (int k = 0; k < 9; ++k) turned.data()[k] = R.data()[k / 3 + 3 * (k % 3)];
  return turned;
}

/// X_AC = X_AB X_BC, bitwise equal to the product of Eigen, which sums the third row from its end.
[[nodiscard]] inline Pose composed(const Pose& X_AB, const Pose& X_BC) noexcept {
  const double* r = X_AB.data();
  Pose X_AC = X_AB;  // copies the last row
  for (std::size_t column = 0; column < 4; ++column) {
    const double* p = X_BC.data() + 4 * column;
    double* q = X_AC.data() + 4 * column;
    q[0] = r[0] * p[0] + r[4] * p[1] + r[8] * p[2];
    q[1] = r[1] * p[0] + r[5] * p[1] + r[9] * p[2];
    q[2] = r[2] * p[0] + (r[6] * p[1] + r[10] * p[2]);
  }
  for (int row = 0; row < 3; ++row) X_AC.data()[12 + row] += r[12 + row];
  return X_AC;
}

/// True when every entry of `X` is finite. Cost: 12 additions.
[[nodiscard]] inline bool is_finite(const Pose& X) noexcept {
  // x - x is 0 for finite x and NaN otherwise; one comparison checks all twelve.
  double zero = 0.0;
  for (std::size_t column = 0; column < 4; ++column) {
    const double* entries = X.data() + 4 * column;
    // NOLINTNEXTLINE(misc-redundant-expression)
    for (int row = 0; row < 3; ++row) zero += entries[row] - entries[row];
  }
  return zero == 0.0;
}

/// True when every entry of `v` is finite.
[[nodiscard]] inline bool is_finite(const Vec3& v) noexcept {
  const Vec3 zero = v - v;  // NOLINT(misc-redundant-expression)
  return zero[0] + zero[1] + zero[2] == 0.0;
}

/// True when every entry of `R` is finite.
template <std::same_as<Mat3> M>
[[nodiscard]] bool is_finite(const M& R) noexcept {
  double zero = 0.0;
  // NOLINTNEXTLINE(misc-redundant-expression)
  for (int k = 0; k < 9; ++k) zero += R.data()[k] - R.data()[k];
  return zero == 0.0;
}

/// True when the rotation of `X` is orthonormal within `tolerance` per entry and right-handed;
/// false when an entry is NaN. Cost: 24 multiplications.
[[nodiscard]] inline bool is_rigid(const Pose& X, double tolerance = 1e-9) noexcept {
  const auto M = [&](int row, int column) { return X.data()[4 * column + row]; };
  const auto product = [&](int i, int j) {
    return M(0, i) * M(0, j) + M(1, i) * M(1, j) + M(2, i) * M(2, j);
  };
  const auto is_near = [&](double value, double ideal) {
    return std::abs(value - ideal) <= tolerance;
  };
  const double volume = M(0, 2) * (M(1, 0) * M(2, 1) - M(2, 0) * M(1, 1)) +
                        M(1, 2) * (M(2, 0) * M(0, 1) - M(0, 0) * M(2, 1)) +
                        M(2, 2) * (M(0, 0) * M(1, 1) - M(1, 0) * M(0, 1));
  return is_near(product(0, 0), 1.0) && is_near(product(1, 1), 1.0) &&
         is_near(product(2, 2), 1.0) && is_near(product(0, 1), 0.0) &&
         is_near(product(0, 2), 0.0) && is_near(product(1, 2), 0.0) && volume > 0.0;
}

}  // namespace repel
