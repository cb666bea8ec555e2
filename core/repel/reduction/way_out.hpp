/// @file
/// Ways out of an overlap.
#pragma once

#include <limits>

#include <repel/reduction/shape.hpp>

namespace repel::detail {

/// How far A would have to move along the unit `n_W` to leave B behind [m]; no less than the
/// penetration depth. Cost: a support-map pair.
[[nodiscard]] inline double overlap_along(const Vec3& n_W, const Shape& A, const Pose& X_WA,
                                          const Shape& B, const Pose& X_WB) noexcept {
  const Level& a = A.level(0);
  const Level& b = B.level(0);
  const Vec<double> n(n_W);
  return b.core.support_value(rotate_transposed(X_WB, n)) +
         a.core.support_value(rotate_transposed(X_WA, -n)) +
         dot(n, column<double>(X_WB, 3) - column<double>(X_WA, 3)) + a.depth + b.depth;
}

/// The axis of either body, world axes, along which A leaves B by the shortest way. Cost: twelve
/// support-map pairs.
[[nodiscard]] inline Vec3 shortest_axis(const Shape& A, const Pose& X_WA, const Shape& B,
                                        const Pose& X_WB) noexcept {
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = Vec3::UnitZ();
  for (int k = 0; k < 12; ++k) {
    const Mat3& R = k < 6 ? X_WA.linear() : X_WB.linear();
    const Vec3 n = (k % 2 == 0 ? 1.0 : -1.0) * R.col(k % 6 / 2);
    const double overlap = overlap_along(n, A, X_WA, B, X_WB);
    if (overlap < least) {
      least = overlap;
      best = n;
    }
  }
  return best;
}

}  // namespace repel::detail
