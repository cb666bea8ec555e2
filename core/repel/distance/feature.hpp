// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A feature (vertex, edge or face) of the Minkowski difference A - B, its point nearest to the
/// origin, and the proof of the lower bound.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <repel/distance/gap.hpp>
#include <repel/distance/query.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// Two convex sets at their poses: the support map of A - B, in world axes around the origin of A,
/// so that rounding errors do not grow with the distance from the world origin.
struct PosedPair {
  const Convex& A;
  const Pose& X_WA;
  const Convex& B;
  const Pose& X_WB;
  Vec<double> p_AB = column<double>(X_WB, 3) - column<double>(X_WA, 3);  ///< [m] world axes

  /// Error bound of a support value due to rounding [m].
  [[nodiscard]] double margin() const noexcept {
    return 0x1p-49 * (A.reach() + B.reach() + sum(magnitudes(p_AB)));
  }
  /// The smallest dot product of v with a point of A - B.
  [[nodiscard]] double least_product(const Vec<double>& v) const noexcept {
    return -(A.support_value(rotate_transposed(X_WA, -v)) +
             B.support_value(rotate_transposed(X_WB, v)) + dot(v, p_AB));
  }
};

/// Up to three points w = a - b of A - B; only the first `size` of them are set.
struct Feature {
  std::array<Vec<double>, 3> a;  ///< [m] points of A, from the origin of A, world axes
  std::array<Vec<double>, 3> w;  ///< [m]
  int size;

  [[nodiscard]] Vec<double> mean(const std::array<Vec<double>, 3>& x,
                                 const Vec<double>& weights) const noexcept {
    if (size == 1) return x[0];
    const Vec<double> two = weights.x() * x[0] + weights.y() * x[1];
    return size == 2 ? two : two + weights.z() * x[2];
  }
};

/// The point of a feature nearest to the origin.
struct Foot {
  Vec<double> v;                       ///< [m]
  Vec<double> weights{1.0, 0.0, 0.0};  ///< barycentric weights of the corners; their sum is 1
};

/// The point nearest to the origin on the affine span of the corners p, q, r; negative weights: it
/// lies outside the feature.
///
///     face    n = (q - p) x (r - p),  v = n (n.p) / n.n,  weights n.(q x r), n.(r x p), n.(p x q)
///     edge    e = q - p,              v = p + t e,        weights 1 - t, t       (t = -p.e / e.e)
///     vertex                          v = p,              weight 1
[[nodiscard]] inline Foot foot_on(const Feature& f) noexcept {
  const auto& [p, q, r] = f.w;
  if (f.size == 1) return {p};
  const Vec<double> e = q - p;
  if (f.size == 2) {
    const double scale = 1.0 / dot(e, e);
    const double first = scale * dot(e, p);
    const Vec<double> slanted = p - first * e;
    // Projected twice: near contact, the error of the first dot product is relative to the size,
    // not to the gap.
    const double rest = scale * dot(e, slanted);
    return {slanted - rest * e, {1.0 + (first + rest), -(first + rest), 0.0}};
  }
  const Vec<double> n = cross(e, r - p);
  const Vec<double> areas = dots(cross(q, r), cross(r, p), cross(p, q), n);
  return {(dot(n, p) / dot(n, n)) * n, (1.0 / sum(areas)) * areas};
}

/// True when the nearest point of A and B is proven to be on `f` within `options`, or the gap is
/// proven to be larger than `beyond` [m]; `gap` is then the result. False for input that is not
/// finite.
/// @param least_vw the smallest dot product of `foot.v` with a point of A - B
[[nodiscard, gnu::always_inline]] inline bool prove(const Feature& f, const Foot& foot,
                                                    double least_vw, double margin,
                                                    const QueryOptions& options, double beyond,
                                                    Gap& gap) noexcept {
  const double vv = dot(foot.v, foot.v);
  const double length = std::sqrt(vv);
  const double lower = (least_vw / length - margin) * (1.0 - 0x1p-51);
  // The same point as a convex combination of points of the sets, valid also where a thin face
  // makes v inaccurate.
  const Vec<double> w = f.mean(f.w, foot.weights);
  const double off = sum(magnitudes(w - foot.v));
  const double upper = (length + off) * (1.0 + 0x1p-51) + margin;
  const bool converged =
      vv - least_vw <= std::max(options.tolerance * vv, margin * length) && off <= margin &&
      upper - lower <= std::max(options.relative_width, 2.0 * options.tolerance) * upper;
  const bool far = lower > beyond;
  const bool inside = foot.weights.x() >= 0.0 && foot.weights.y() >= 0.0 && foot.weights.z() >= 0.0;
  // Where squares underflow or overflow, the bounds are none.
  if (!(inside && (converged || far) && length >= 1e-150 && length <= 1e150)) return false;
  gap.distance = std::clamp(length, lower, upper);
  gap.lower = lower;
  gap.upper = upper;
  // Adding zero turns a negative zero into a positive one.
  gap.n_BA_W = (1.0 / length) * foot.v + Vec<double>();
  gap.p_AQa_W = f.mean(f.a, foot.weights);
  gap.p_AQb_W = gap.p_AQa_W - w;
  gap.end = far ? QueryEnd::far_apart : QueryEnd::converged;
  return true;
}

/// Replays the result of the last tick, one to three point pairs kept in `warm`: if they still
/// contain the nearest point, a single evaluation of both support functions proves it.
[[nodiscard, gnu::always_inline]] inline bool confirm_nearest(const PosedPair& pair,
                                                              const WarmStart& warm,
                                                              const QueryOptions& options,
                                                              double beyond, Gap& gap) noexcept {
  Feature f;
  f.size = std::min<int>(warm.size, 3);
  for (int i = 0; i < f.size; ++i) {
    f.a[i] = rotate(pair.X_WA, pair.A.place(warm.a[i]));
    f.w[i] = f.a[i] - (rotate(pair.X_WB, pair.B.place(warm.b[i])) + pair.p_AB);
  }
  const Foot foot = foot_on(f);
  gap.iterations = 1;
  return prove(f, foot, pair.least_product(foot.v), pair.margin(), options, beyond, gap);
}

/// True when the four points of A - B named in `warm.met_a` and `warm.met_b` are proven to enclose
/// the origin, so that the sets intersect.
[[nodiscard]] inline bool still_meets(const PosedPair& pair, const WarmStart& warm) noexcept {
  std::array<Vec<double>, 4> w;
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = rotate(pair.X_WA, pair.A.place(warm.met_a[i])) -
           (rotate(pair.X_WB, pair.B.place(warm.met_b[i])) + pair.p_AB);
  }
  const Vec<double> edge = w[0] - w[1];
  const Vec<double> across = cross(w[2], w[3]);
  const Vec<double> along = w[2] - w[3];
  const Vec<double> other = cross(w[0], w[1]);
  // Six times the volumes between the origin and each face, with the orientation seen from the
  // opposite corner.
  const std::array<double, 4> volumes{dot(w[1], across), -dot(w[0], across), dot(w[3], other),
                                      -dot(w[2], other)};
  const std::array<Vec<double>, 4> normals{across + cross(w[1], along), across + cross(w[0], along),
                                           other + cross(w[3], edge), other + cross(w[2], edge)};
  const double size = pair.A.reach() + pair.B.reach() + sum(magnitudes(pair.p_AB));
  const double rounding = 0x1p-46 * size * size * size;
  const double sign = volumes[0] < 0.0 ? -1.0 : 1.0;
  const double margin = pair.margin();
  bool inside = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const double volume = sign * volumes[k];
    inside = inside && volume > rounding &&
             volume * volume > margin * margin * dot(normals[k], normals[k]);
  }
  return inside;
}

}  // namespace repel::detail
