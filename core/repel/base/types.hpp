/// @file
/// The vector and pose types every room shares, in SI units.
///
/// Frames are part of a name: `X_WB` is the pose of B in W, `p_WQ` the position of Q from the
/// origin of W, `n_AB_W` a direction from A to B expressed in W.
#pragma once

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

/// True when the rotation of `X` is orthonormal and right-handed within `tolerance` per entry.
[[nodiscard]] inline bool is_rigid(const Pose& X, double tolerance = 1e-9) noexcept {
  const Mat3 R = X.linear();
  const Mat3 defect = R.transpose() * R - Mat3::Identity();
  return defect.cwiseAbs().maxCoeff() <= tolerance && R.determinant() > 0.0;
}

}  // namespace repel
