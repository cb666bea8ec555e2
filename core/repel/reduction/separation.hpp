// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The signed distance of two shapes: the result for one pair.
#pragma once

#include <repel/distance/box_depth.hpp>
#include <repel/distance/expanding_polytope.hpp>
#include <repel/distance/feature_search.hpp>
#include <repel/reduction/deepest_point.hpp>
#include <repel/reduction/ladder_walk.hpp>

namespace repel {

namespace detail {

/// True when all pose entries are finite and small enough that products of three do not overflow.
[[nodiscard]] inline bool are_usable(const Pose& X_WA, const Pose& X_WB) noexcept {
  // A comparison with NaN is false; one comparison checks all entries.
  Vec<double> largest{};
  for (int k = 0; k < 4; ++k) {
    largest = largest + (magnitudes(column<double>(X_WA, k)) + magnitudes(column<double>(X_WB, k)));
  }
  return sum(largest) <= 1e15;
}

[[nodiscard]] inline bool are_usable(const QueryOptions& options) noexcept {
  return options.tolerance >= 0.0 && options.iterations >= 1 && options.ignore_beyond >= 0.0 &&
         options.relative_width >= 0.0;
}

/// True when the last query ended on a feature of the shapes themselves, not of reduced levels.
[[nodiscard]] inline bool has_feature(const WarmStart& warm) noexcept {
  return warm.size >= 1 && warm.size <= 3 && warm.level_a == 0 && warm.level_b == 0;
}

[[nodiscard]] inline bool are_angular(const Level& a, const Level& b) noexcept {
  return a.core.is_polytope() && b.core.is_polytope();
}

/// The query options for the cores, for the rounded shapes to meet `options`.
[[nodiscard]] inline QueryOptions options_of_cores(const Level& a, const Level& b,
                                                   const QueryOptions& options) noexcept {
  QueryOptions of_cores = options;
  of_cores.ignore_beyond += a.depth + b.depth;
  // Rounded shapes can be much nearer to each other, and a search on a curve converges only
  // asymptotically.
  if (!are_angular(a, b) || a.depth + b.depth > 0.0) of_cores.tolerance *= 0.01;
  return of_cores;
}

[[nodiscard]] inline bool is_by_planes(const Shape& A, const Shape& B,
                                       const QueryOptions& options) noexcept {
  return options.measure == Measure::deepest_point && !A.planes().empty() && !B.planes().empty();
}

/// True when overlap is measured by the levels of the shapes, as requested or as the fallback.
[[nodiscard]] inline bool is_by_levels(const Shape& A, const Shape& B,
                                       const QueryOptions& options) noexcept {
  if (options.measure == Measure::exact) return !are_angular(A.level(0), B.level(0));
  return !is_by_planes(A, B, options);
}

/// The result by the deepest common point of the cores; false when there is none or it takes more
/// than `most_pivots`.
/// @param doubted see DeepestPoint
[[nodiscard]] inline bool find_deepest_point(PosedShape A, PosedShape B, int most_pivots,
                                             bool doubted, WarmStart& warm,
                                             Separation& s) noexcept {
  const Level& a = A.shape.level(0);
  const Level& b = B.shape.level(0);
  const PosedPlanes planes_a{A.shape.planes(), A.X_W, a.core.reach()};
  const PosedPlanes planes_b{B.shape.planes(), B.X_W, b.core.reach()};
  DeepestPoint deepest(planes_a, planes_b);
  if (!deepest.solve(warm, most_pivots, doubted)) return false;
  // The planes may enclose more than the shape, by their margin, and rounding may put the point
  // outside. Both are subtracted from the depth.
  const double found = std::max(0.0, deepest.depth(0)) + std::max(0.0, deepest.depth(1));
  const double margins = A.shape.planes().margin() + B.shape.planes().margin();
  const double sure = 1.0 - (margins + deepest.outside()) / found;
  if (!(sure > 0.0)) return false;
  const double depth_a = sure * std::max(0.0, deepest.depth(0)) + a.depth;
  const double depth_b = sure * std::max(0.0, deepest.depth(1)) + b.depth;
  const double slack = 1e-14 * (A.shape.reach() + B.shape.reach());
  // The extraction direction is the negative gradient. The support maps take it unnormalized, so
  // that they need not wait for its length.
  const Vec<double> d = -deepest.gradient();
  const double times_length = cores_overlap_along(d, A, B);
  const double length = std::sqrt(dot(d, d));
  // With a zero gradient, no direction is better by this measure.
  const bool flat = !(length > 1e-9);
  s.extraction_W = flat ? shortest_axis(A, B) : to_vec3((1.0 / length) * d);
  const Vec3 common = origin(A.X_W) + to_vec3(deepest.point());
  s.p_WA = common - depth_a * s.extraction_W;
  s.p_WB = common + depth_b * s.extraction_W;
  s.distance = -(depth_a + depth_b);
  s.upper = widened(s.distance + slack, 1.0);
  const double overlap =
      flat ? overlap_along(s.extraction_W, A, B) : times_length / length + a.depth + b.depth;
  s.lower = widened(std::min(s.distance, -overlap - slack), -1.0);
  s.level = 0;
  s.iterations += 1 + deepest.pivots() + (flat ? 12 : 0);
  s.end = QueryEnd::converged;
  return true;
}

/// The result by the penetration depth; false for curved cores and for those without volume.
/// @param warm the polytope of the last result, or names of four corners of A - B that enclose the
/// origin
[[nodiscard]] inline bool find_exact_depth(PosedShape A, PosedShape B, WarmStart& warm,
                                           Separation& s) noexcept {
  const Level& a = A.shape.level(0);
  const Level& b = B.shape.level(0);
  if (!are_angular(a, b)) return false;
  const PosedPair pair{a.core, A.X_W, b.core, B.X_W};
  const bool boxes = a.core.kind() == Convex::Kind::box && b.core.kind() == Convex::Kind::box;
  const Depth depth = boxes ? BoxDepth(pair).run() : ExpandingPolytope(pair).run(warm);
  if (!(depth.upper < std::numeric_limits<double>::infinity())) return false;
  const double rounded = a.depth + b.depth;
  s.distance = -(depth.value + rounded);
  s.lower = std::min(s.distance, widened(-(depth.upper + rounded), -1.0));
  s.upper = std::max(s.distance, widened(-(depth.lower + rounded), 1.0));
  s.extraction_W = to_vec3(-depth.n_W);
  const Vec3 p_WQ = origin(A.X_W) + to_vec3(depth.p_AQa_W);
  s.p_WA = p_WQ - a.depth * s.extraction_W;
  s.p_WB = s.p_WA - s.distance * s.extraction_W;
  s.level = 0;
  s.iterations += depth.iterations;
  s.end = depth.closed ? QueryEnd::converged : QueryEnd::budget_spent;
  return true;
}

/// True if the last query ended in an overlap, measurable again without a search for corners
/// enclosing the origin.
[[nodiscard]] inline bool overlapped(const Shape& A, const Shape& B,
                                     const WarmStart& warm) noexcept {
  if (warm.level_a >= WarmStart::exact_depth) return true;
  return warm.size == 4 && warm.level_a == 0 && A.level(0).core.kind() == Convex::Kind::box &&
         B.level(0).core.kind() == Convex::Kind::box;
}

/// The result for an overlap of the cores by a measure other than their levels; false when the
/// levels are the requested measure, or when the cores turn out not to overlap.
/// @param spent support-map pairs evaluated
/// @param doubted no search has proven the overlap
[[nodiscard]] inline bool measure_overlap(PosedShape A, PosedShape B, const QueryOptions& options,
                                          int spent, bool doubted, WarmStart& warm,
                                          Separation& s) noexcept {
  s.iterations = spent;
  if (is_by_planes(A.shape, B.shape, options)) {
    return find_deepest_point(A, B, options.iterations - spent, doubted, warm, s);
  }
  return options.measure == Measure::exact && find_exact_depth(A, B, warm, s) &&
         s.upper < -(A.shape.level(0).depth + B.shape.level(0).depth);
}

/// The signed distance when the fast search, after `spent` support-map pairs, has no proof.
[[gnu::noinline]] inline Separation carefully_searched(PosedShape A, PosedShape B,
                                                       const QueryOptions& options, int spent,
                                                       WarmStart& warm) noexcept {
  const Level& a = A.shape.level(0);
  const Level& b = B.shape.level(0);
  if (!is_by_levels(A.shape, B.shape, options) && (warm.level_a != 0 || warm.level_b != 0)) {
    warm = {};
  }
  LadderWalk walk(A, B, options, warm);
  if (warm.level_a != 0 || warm.level_b != 0) return walk.run(nullptr);
  QueryOptions of_cores = options_of_cores(a, b, options);
  of_cores.iterations = std::max(1, options.iterations - spent);
  Gap gap = gap_between(a.core, A.X_W, b.core, B.X_W, of_cores, warm);
  gap.iterations += spent;
  if (!gap.meets && gap.lower > 0.0) return apart(gap, a.depth, b.depth, A.X_W);
  Separation s;
  // If the origin is deep inside but coplanar with all support points found, it looks like contact
  // to GJK.
  const bool meets = gap.meets || gap.end == QueryEnd::touching;
  if (meets && measure_overlap(A, B, options, gap.iterations, false, warm, s)) return s;
  s = walk.run(&gap);
  // The levels are the fallback of an unfinished measure: report that if the iterations ran short
  // or the levels find a depth above rounding.
  const double depth_of_cores = s.distance + a.depth + b.depth;
  const double margin = A.shape.planes().margin() + B.shape.planes().margin();
  const bool deep = depth_of_cores < -1e-13 * (A.shape.reach() + B.shape.reach()) - margin;
  const bool spent_early = options.iterations - gap.iterations < DeepestPoint::most_pivots;
  if (meets && (deep || spent_early) && !is_by_levels(A.shape, B.shape, options)) {
    s.end = QueryEnd::budget_spent;
  }
  return s;
}

/// The signed distance by search, starting from the warm start.
[[gnu::noinline]] inline Separation searched(PosedShape A, PosedShape B,
                                             const QueryOptions& options,
                                             WarmStart& warm) noexcept {
  if (!are_usable(A.X_W, B.X_W)) return {};
  const Level& a = A.shape.level(0);
  const Level& b = B.shape.level(0);
  if (overlapped(A.shape, B.shape, warm)) {
    Separation s;
    if (measure_overlap(A, B, options, 0, true, warm, s)) return s;
  }
  Gap gap;
  if (warm.level_a == 0 && warm.level_b == 0 && are_angular(a, b)) {
    FeatureSearch search({a.core, A.X_W, b.core, B.X_W});
    if (search.run(options_of_cores(a, b, options), warm, gap)) {
      return apart(gap, a.depth, b.depth, A.X_W);
    }
    if (warm.size == 4) {
      Separation s;
      if (measure_overlap(A, B, options, gap.iterations, true, warm, s)) return s;
    }
  }
  return carefully_searched(A, B, options, gap.iterations, warm);
}

}  // namespace detail

/// True when the measure needs the levels of every shape that overlaps this one, and its own.
[[nodiscard]] inline bool needs_levels(const Shape& shape, Measure measure) noexcept {
  return detail::is_by_levels(shape, shape, {.measure = measure});
}

/// The signed distance of A and B.
///
/// While the shapes are apart (or only their rounded rims overlap) it is the distance itself, from
/// GJK, with the error that `docs/accuracy.md` states for every pair of shapes. In overlap it is
/// minus the depth by `options.measure` (see `docs/reduction.md`): continuous, 1-Lipschitz in
/// translation, never deeper than the penetration depth; `lower` and `upper` bracket the true one.
///
/// @param X_WA,X_WB rigid poses in the world [m]; entries that are not finite end in bad_input, and
/// so do those beyond 1e15 m, unless the last result still holds
/// @param warm state left by the last call on this pair; any content is safe
/// Cost: one to three support-map pairs per call when warm. No heap, no lock, bounded by
/// `options.iterations`.
[[nodiscard, gnu::flatten]] inline Separation separation(const Shape& A, const Pose& X_WA,
                                                         const Shape& B, const Pose& X_WB,
                                                         const QueryOptions& options,
                                                         WarmStart& warm) noexcept {
  if (!detail::are_usable(options)) return {};
  if (detail::has_feature(warm)) {
    const Level& a = A.level(0);
    const Level& b = B.level(0);
    const double beyond = options.ignore_beyond + a.depth + b.depth;
    Gap gap;
    if (detail::confirm_nearest({a.core, X_WA, b.core, X_WB}, warm, options, beyond, gap)) {
      return detail::apart(gap, a.depth, b.depth, X_WA);
    }
  }
  return detail::searched({A, X_WA}, {B, X_WB}, options, warm);
}

/// The same without a warm start.
[[nodiscard]] inline Separation separation(const Shape& A, const Pose& X_WA, const Shape& B,
                                           const Pose& X_WB,
                                           const QueryOptions& options = {}) noexcept {
  WarmStart cold;
  return separation(A, X_WA, B, X_WB, options, cold);
}

}  // namespace repel
