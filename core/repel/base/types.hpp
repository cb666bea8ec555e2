/// @file
/// The vector and pose types every room shares, in SI units.
///
/// Frames are part of a name: `X_WB` is the pose of B in W, `p_WQ` the position of Q from the
/// origin of W, `n_AB_W` a direction from A to B expressed in W.
#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace repel {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;

/// True when every entry of `X` is finite. Cost: 12 additions.
[[nodiscard]] inline bool is_finite(const Pose& X) noexcept {
  // x - x is 0 for finite x and NaN otherwise; one comparison settles all twelve.
  const auto& M = X.matrix();
  double zero = 0.0;
  for (int column = 0; column < 4; ++column) {
    // NOLINTNEXTLINE(misc-redundant-expression)
    for (int row = 0; row < 3; ++row) zero += M(row, column) - M(row, column);
  }
  return zero == 0.0;
}

/// True when every entry of `v` is finite.
[[nodiscard]] inline bool is_finite(const Vec3& v) noexcept {
  return (v - v).sum() == 0.0;  // NOLINT(misc-redundant-expression)
}

/// True when the rotation of `X` is orthonormal and right-handed within `tolerance` per entry; not
/// when an entry is no number. Cost: 24 multiplications.
[[nodiscard]] inline bool is_rigid(const Pose& X, double tolerance = 1e-9) noexcept {
  const auto& M = X.matrix();
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
