// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The penetration depth of two boxes by the separating axis test: the least overlap along fifteen
/// axes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <repel/distance/depth.hpp>
#include <repel/distance/feature.hpp>

namespace repel::detail {

/// The penetration depth of overlapping boxes: the least overlap along the face normals of both and
/// the cross products of their edges (Gottschalk, Lin and Manocha 1996), one of which is the
/// shortest separating direction.
class BoxDepth {
 public:
  explicit BoxDepth(const PosedPair& pair) noexcept
      : pair_(pair),
        half_a_(pair.A.half_extents()),
        half_b_(pair.B.half_extents()),
        axes_a_{column<double>(pair.X_WA, 0), column<double>(pair.X_WA, 1),
                column<double>(pair.X_WA, 2)},
        axes_b_{column<double>(pair.X_WB, 0), column<double>(pair.X_WB, 1),
                column<double>(pair.X_WB, 2)} {}

  [[nodiscard, gnu::noinline]] Depth run() noexcept {
    for (int i = 0; i < 3; ++i) consider(axes_a_[i], i, none);
    for (int j = 0; j < 3; ++j) consider(axes_b_[j], none, j);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) consider(product(axes_a_[i], axes_b_[j]), i, j);
    }
    Depth depth;
    const double margin = 4.0 * pair_.margin();
    depth.value = least_;
    depth.lower = std::max(0.0, least_ - margin);
    depth.upper = least_ + margin;
    depth.n_W = n_;
    depth.p_AQa_W = witness();
    depth.iterations = 15;
    depth.closed = true;
    return depth;
  }

 private:
  static constexpr int none = -1;

  // For nearly parallel edges the cross product suffers from cancellation: it is formed in extended
  // precision.
  [[nodiscard]] static Vec<double> product(const Vec<double>& a, const Vec<double>& b) noexcept {
    const Vec<double> axis = cross(a, b);
    if (dot(axis, axis) > 0.01) return axis;
    return Vec<double>(cross(Vec<DoubleDouble>(a), Vec<DoubleDouble>(b)));
  }

  void consider(const Vec<double>& axis, int i, int j) noexcept {
    const double length = std::sqrt(dot(axis, axis));
    // Parallel edges: the shortest separating direction is a face normal.
    if (!(length > 1e-30)) return;
    const Vec<double> n = (1.0 / length) * axis;
    const double along = dot(n, pair_.p_AB);
    const double overlap = dot(half_a_, magnitudes(dots(axes_a_[0], axes_a_[1], axes_a_[2], n))) +
                           dot(half_b_, magnitudes(dots(axes_b_[0], axes_b_[1], axes_b_[2], n))) -
                           std::abs(along);
    if (!(overlap < least_)) return;
    least_ = overlap;
    n_ = std::copysign(1.0, along) * n;
    i_ = i;
    j_ = j;
  }

  /// The farthest point of a box along n; on an edge or face that is farthest as a whole, the point
  /// nearest to `toward`.
  /// @param n, toward in world axes; `toward` and the result [m] from the centre of the box
  [[nodiscard]] static Vec<double> farthest(const Pose& X_W, const Vec<double>& half,
                                            const Vec<double>& n,
                                            const Vec<double>& toward) noexcept {
    const Vec3 d = to_vec3(rotate_transposed(X_W, n));
    const Vec3 t = to_vec3(rotate_transposed(X_W, toward));
    const Vec3 h = to_vec3(half);
    Vec3 x;
    for (int k = 0; k < 3; ++k) {
      x[k] = std::abs(d[k]) > 1e-9 ? std::copysign(h[k], d[k]) : std::clamp(t[k], -h[k], h[k]);
    }
    return rotate(X_W, Vec<double>(x));
  }

  /// The witness point on A, which leaves B last. For a face of A: the projection of the deepest
  /// point of B onto it; for a face of B: the deepest point of A; for two edges: the point of the
  /// edge of A nearest to the edge of B.
  [[nodiscard]] Vec<double> witness() const noexcept {
    const Vec<double>& p = pair_.p_AB;
    const Vec<double> a = farthest(pair_.X_WA, half_a_, n_, p);
    if (i_ == none) return a;
    const Vec<double> b = farthest(pair_.X_WB, half_b_, -n_, -p) + p;
    if (j_ == none) return b + least_ * n_;
    const Vec<double>& u = axes_a_[i_];
    const Vec<double>& v = axes_b_[j_];
    const Vec<double> c = cross(u, v);
    return a + (dot(cross(b - a, v), c) / dot(c, c)) * u;
  }

  PosedPair pair_;
  Vec<double> half_a_, half_b_;                             ///< [m]
  std::array<Vec<double>, 3> axes_a_, axes_b_;              ///< unit, world axes
  double least_ = std::numeric_limits<double>::infinity();  ///< [m]
  Vec<double> n_;
  int i_ = none;
  int j_ = none;
};

}  // namespace repel::detail
