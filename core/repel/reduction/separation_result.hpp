// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The result for one pair of shapes.
#pragma once

#include <cmath>
#include <limits>

#include <repel/base/lanes.hpp>
#include <repel/base/types.hpp>
#include <repel/distance/gap.hpp>

namespace repel {

/// The result for one pair; never claims more than was proven. The default makes no claim.
struct Separation {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the depth of overlap
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] lower bound, always valid
  double upper = std::numeric_limits<double>::infinity();   ///< [m] upper bound, always valid
  /// [m] Witness points in world. On the shapes while they are apart; in overlap, on the levels
  /// compared, moved outward by their depth. (p_WA - p_WB).extraction_W is the distance, or more
  /// where an intersecting pair of levels decides it.
  Vec3 p_WA{0, 0, 0};
  Vec3 p_WB{0, 0, 0};                  ///< [m] on B, likewise
  Vec3 extraction_W{0, 0, 0};          ///< unit; moving A along it separates A from B
  int level = 0;                       ///< 0: the shapes themselves; k: k-th step of the reduction
  int iterations = 0;                  ///< support-map pairs evaluated
  QueryEnd end = QueryEnd::bad_input;  ///< why the query stopped
  int level_a = 0;  ///< of A, on which its witness point is; `level` is the larger of both
  int level_b = 0;  ///< of B
};

namespace detail {

[[nodiscard]] inline double magnitudes(double x) noexcept {
  return std::abs(x);
}

/// A bound moved outward after sums that may each have rounded inward; `outward` is its side, -1 or
/// 1. A double, or Lanes with one bound per lane.
template <class Number>
[[nodiscard]] Number widened(const Number& bound, double outward) noexcept {
  return bound + (outward * 0x1p-51) * magnitudes(bound);
}

/// The members of Separation for two disjoint cores, each with its depth [m] around it: for one
/// pair with double and Vec<double>, for one pair per lane with Lanes and LaneVec.
template <class Number, class Vector>
struct Apart {
  Number distance, lower, upper;    ///< [m]
  Vector p_WA, p_WB, extraction_W;  ///< [m], [m], unit

  Apart() = default;
  /// @param gap of the cores: a Gap, or a LaneGap
  /// @param p_WoA [m] the world position of the origin of A
  template <class CoreGap>
  Apart(const CoreGap& gap, const Number& depth_a, const Number& depth_b,
        const Vector& p_WoA) noexcept
      : distance(gap.distance - (depth_a + depth_b)),
        lower(widened<Number>(gap.lower - (depth_a + depth_b), -1.0)),
        upper(widened<Number>(gap.upper - (depth_a + depth_b), 1.0)),
        p_WA(p_WoA + gap.p_AQa_W - depth_a * gap.n_BA_W),
        p_WB(p_WoA + gap.p_AQb_W + depth_b * gap.n_BA_W),
        extraction_W(gap.n_BA_W) {}
};

/// The result for two disjoint cores, each with its depth [m] around it.
inline Separation apart(const Gap& gap, double depth_a, double depth_b, const Pose& X_WA) noexcept {
  const Apart<double, Vec<double>> found(gap, depth_a, depth_b, column<double>(X_WA, 3));
  Separation s;
  s.distance = found.distance;
  s.lower = found.lower;
  s.upper = found.upper;
  s.p_WA = to_vec3(found.p_WA);
  s.p_WB = to_vec3(found.p_WB);
  s.extraction_W = to_vec3(found.extraction_W);
  s.iterations = gap.iterations;
  s.end = gap.end;
  return s;
}

}  // namespace detail
}  // namespace repel
