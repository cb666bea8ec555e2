/// @file
/// The answer for one pair of shapes.
#pragma once

#include <cmath>
#include <limits>

#include <repel/base/types.hpp>
#include <repel/distance/gap.hpp>

namespace repel {

/// The answer for one pair; never claims more than was proven. A default one claims nothing.
struct Separation {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the intrusion distance
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] the true signed distance lies
  double upper = std::numeric_limits<double>::infinity();   ///< [m] in [lower, upper], always
  /// [m] Witness points in world. On the shapes while they are apart; in overlap, on the levels
  /// compared and carried out by their depth. (p_WA - p_WB).extraction_W is the distance, or more
  /// where a pair of levels that meets decides it.
  Vec3 p_WA{0, 0, 0};
  Vec3 p_WB{0, 0, 0};
  Vec3 extraction_W{0, 0, 0};  ///< unit; moving A along it takes A away from B
  int level = 0;               ///< 0: the shapes themselves; k: k-th step of the reduction
  int iterations = 0;          ///< support-map pairs evaluated
  QueryEnd end = QueryEnd::bad_input;
};

namespace detail {

/// A bound after sums that may each have rounded inward; `outward` is its side, -1 or 1.
inline double widened(double bound, double outward) noexcept {
  return bound + outward * 0x1p-51 * std::abs(bound);
}

/// The answer of two cores that are apart, each with its depth [m] around it.
inline Separation apart(const Gap& gap, double depth_a, double depth_b, const Pose& X_WA) noexcept {
  Separation s;
  const double depth = depth_a + depth_b;
  s.distance = gap.distance - depth;
  s.lower = widened(gap.lower - depth, -1.0);
  s.upper = widened(gap.upper - depth, 1.0);
  const Vec<double> p_WA = column<double>(X_WA, 3);
  s.p_WA = to_vec3(p_WA + gap.p_AQa_W - depth_a * gap.n_BA_W);
  s.p_WB = to_vec3(p_WA + gap.p_AQb_W + depth_b * gap.n_BA_W);
  s.extraction_W = to_vec3(gap.n_BA_W);
  s.iterations = gap.iterations;
  s.end = gap.end;
  return s;
}

}  // namespace detail
}  // namespace repel
