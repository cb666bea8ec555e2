// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Separating translations of an overlap.
#pragma once

#include <algorithm>
#include <limits>

#include <repel/reduction/convex_shape.hpp>

namespace repel::detail {

/// How far the core of A would have to move along `d` to separate from that of B, times the length
/// of d [m]. Cost: a support-map pair.
[[nodiscard]] inline double cores_overlap_along(const Vec<double>& d, PosedShape A,
                                                PosedShape B) noexcept {
  return B.shape.level(0).core.support_value(rotate_transposed(B.X_W, d)) +
         A.shape.level(0).core.support_value(rotate_transposed(A.X_W, -d)) +
         dot(d, column<double>(B.X_W, 3) - column<double>(A.X_W, 3));
}

/// How far A would have to move along the unit `n_W` to separate from B [m]; an upper bound of the
/// penetration depth. Cost: a support-map pair.
[[nodiscard]] inline double overlap_along(const Vec3& n_W, PosedShape A, PosedShape B) noexcept {
  return cores_overlap_along(Vec<double>(n_W), A, B) + A.shape.level(0).depth +
         B.shape.level(0).depth;
}

/// The axis of either body, in world axes, with the shortest translation that separates A from B.
/// Cost: six support-map pairs for boxes, otherwise twelve.
[[nodiscard]] inline Vec3 shortest_axis(PosedShape A, PosedShape B) noexcept {
  const auto is_box = [](const Shape& s) { return s.level(0).core.kind() == Convex::Kind::box; };
  // Then both signs of an axis from one evaluation.
  const bool alike = is_box(A.shape) && is_box(B.shape);
  const Vec<double> p_AB = column<double>(B.X_W, 3) - column<double>(A.X_W, 3);
  double least = std::numeric_limits<double>::infinity();
  Vec<double> best(0.0, 0.0, 1.0);
  for (int k = 0; k < 6; ++k) {
    const Vec<double> n = column<double>(k < 3 ? A.X_W : B.X_W, k % 3);
    const double along = cores_overlap_along(n, A, B);
    const double against = alike ? along - 2.0 * dot(n, p_AB) : cores_overlap_along(-n, A, B);
    if (std::min(along, against) >= least) continue;
    least = std::min(along, against);
    best = along <= against ? n : -n;
  }
  return to_vec3(best);
}

}  // namespace repel::detail
