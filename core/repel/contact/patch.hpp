// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The contact patch of a pair: the region between nearly parallel features, in place of one point.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/base/spatial.hpp>
#include <repel/contact/flat.hpp>
#include <repel/contact/overlap.hpp>
#include <repel/contact/tilt_mean.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/reduction/separation_result.hpp>

namespace repel {

/// The distance of two shapes as its mean over all small tilts of one against the other. The
/// distance itself has a kink at parallel features: its gradient, the line of action of the force,
/// jumps from corner to corner. The mean has none. It equals the distance if the nearest point is
/// the same under all tilts, and, by an added term, at parallel faces. Elsewhere it differs by at
/// most ForceLaw::most_nearer.
struct ContactPatch {
  double nearer = 0.0;  ///< [m] the distance minus that of the patch, of either sign
  /// The gradient of the mean when A moves: the wrench on A of a unit force, [1] and [m] about
  /// `Separation::p_WA`, world axes. That on B is the opposite.
  Wrench gradient;
};

namespace detail {

/// False if no edge of a box, or neither cap nor side of a cylinder, is perpendicular to a
/// direction within `angle` [rad], and of an ellipsoid.
[[nodiscard]] inline bool may_be_flat(const Convex& set, const Pose& X, const Vec<double>& n_W,
                                      double angle) noexcept {
  if (set.kind() == Convex::Kind::ellipsoid) return false;
  if (set.kind() != Convex::Kind::box && set.kind() != Convex::Kind::cylinder) return true;
  const Vec<double> n = magnitudes(rotate_transposed(X, n_W));
  if (set.kind() == Convex::Kind::box) return std::min(std::min(n.x(), n.y()), n.z()) < angle;
  return n.z() < angle || n.x() * n.x() + n.y() * n.y() < angle * angle;
}

/// Two nearly parallel segments crossing each other: the gap grows to both sides of the crossing,
/// by `sine` `lean` x^2 / 2.
struct Crossing {
  double sine = 0.0;  ///< of the angle from B to A around the normal
  double lean = 0.0;  ///< [1/m] how much the normal of the pair leans to the side along them
  double tilt = 0.0;  ///< [rad] falls to zero as they turn apart
  double fall = 0.0;  ///< of `tilt` with the angle

  static constexpr double widest = 0.2;         ///< [rad]
  static constexpr double least_radius = 1e-3;  ///< [m] of two touching sharp edges

  Crossing() = default;
  /// @param gap [m] between the segments
  /// @param radius [m] sum of those of curvature across them
  Crossing(const Outline& a, const Outline& b, double gap, double radius, double most) noexcept {
    const Planar u = a.at(1).r - a.at(0).r;
    const Planar v = b.at(1).r - b.at(0).r;
    sine = (dot(u, v) < 0.0 ? -1.0 : 1.0) * cross(v, u) / (norm(u) * norm(v));
    lean = sine / (std::max(least_radius, std::abs(gap)) + radius);
    const double inside = 1.0 - sine * sine / (widest * widest);
    if (!(inside > 0.0)) return;
    tilt = most * inside * inside;
    fall = -4.0 * most * inside * sine / (widest * widest);
  }
};

/// h(s) [m]: the gap at r = 0 less the least gap. It is 0 if the nearest points are those of the
/// features; in overlap, a measure may name others.
[[nodiscard]] inline double farthest_along(const Outline& outline, const Planar& s) noexcept {
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < outline.size; ++i) most = std::max(most, dot(s, outline.at(i).r));
  return most;
}

/// In overlap, features and measure agree if only the features bound the depth. Elsewhere the patch
/// has the distance of its features while they are nearly parallel, else that of the measure: this
/// is the share of the latter.
[[nodiscard]] inline double share_of_measure(double lean, double tilt) noexcept {
  return std::clamp((lean - 2.0 * tilt) / (3.0 * tilt), 0.0, 1.0);
}

[[nodiscard]] inline Planar along(const Planar& unit, const Planar& v) noexcept {
  return dot(unit, v) * unit;
}

}  // namespace detail

/// The patch around the nearest points of two shapes.
/// @param s their `separation` at these poses
/// @param tilt [rad] radius of the disc of tilts, more than 0, a few thousandths
/// @return false for none: the same point is nearest under all tilts, or no direction is known.
/// `patch` is then unchanged Cost: without a patch a look at the nearest features, else several
/// times that of a warm `separation` of boxes. No heap, bounded.
[[nodiscard]] inline bool find_patch(const Separation& s, PosedShape A, PosedShape B, double tilt,
                                     ContactPatch& patch) noexcept {
  using namespace detail;
  if (!(norm(s.extraction_W) > 0.5)) return false;
  const Level& level_a = A.shape.level(s.level_a);
  const Level& level_b = B.shape.level(s.level_b);
  const Vec<double> n(s.extraction_W);
  const double angle = flat_within(tilt);
  if (!may_be_flat(level_a.core, A.X_W, n, angle) || !may_be_flat(level_b.core, B.X_W, n, angle)) {
    return false;
  }
  const PlanarAxes axes(n);
  const Vec<double> nearest_a = Vec<double>(s.p_WA) + level_a.depth * n;
  const Vec<double> nearest_b = Vec<double>(s.p_WB) - level_b.depth * n;
  const double gap = dot(n, nearest_a - nearest_b);
  Flat a = FlatSearch(level_a.core, A.X_W, axes, Facing::down, nearest_a - column<double>(A.X_W, 3),
                      tilt)
               .run();
  if (a.outline.size < 2) return false;
  Flat b = FlatSearch(level_b.core, B.X_W, axes, Facing::up, nearest_b - column<double>(B.X_W, 3),
                      a.tilt)
               .run();
  if (b.outline.size < 2) return false;
  Crossing crossing;
  crossing.tilt = b.tilt;
  if (a.outline.size == 2 && b.outline.size == 2) {
    crossing = Crossing(a.outline, b.outline, gap, a.radius + b.radius, b.tilt);
  }
  if (!(crossing.tilt > 0.0)) return false;
  Outline outline;
  Sides sides;
  if (!find_overlap(a.outline, b.outline, gap > 0.0, outline, sides)) return false;
  outline.bend = crossing.sine * crossing.lean;
  outline.is_exact = !a.is_disc && !b.is_disc;
  Planar slope_a = a.slope;
  Planar slope_b = b.slope;
  Planar unit{};
  if (outline.size == 2) {
    const Planar edge = outline.at(1).r - outline.at(0).r;
    unit = (1.0 / norm(edge)) * edge;
    slope_a = along(unit, slope_a);
    slope_b = along(unit, slope_b);
  }
  const Planar lean = slope_b - slope_a;
  const TiltMean mean(outline, sides, lean, crossing.tilt, std::max(norm(slope_a), norm(slope_b)));
  const Planar& r = mean.point();
  // Forces act normal to the surface of A, or of B beyond the border of A. They act off the normal
  // for crossing segments with the nearest point beside the crossing.
  const Vec<double> off = axes.in_world(slope_a);
  const Planar aside = crossing.lean * dot(unit, r) * Planar{-unit.y, unit.x};
  const double twist = crossing.lean * mean.square() - crossing.fall * mean.widened();
  const Vec<double> force = n - (1.0 - mean.held()) * off + axes.in_world(mean.pull() + aside);
  const Vec<double> point = axes.in_world(r) + dot(slope_a, r) * n;
  const Vec<double> torque = cross(point, n - off) + (mean.drill() + twist) * n +
                             cross(n, axes.in_world(mean.lifted(slope_a)) + level_a.depth * force);
  patch.nearer =
      mean.nearer() - share_of_measure(norm(lean), b.tilt) * farthest_along(outline, lean);
  patch.gradient = {to_vec3(force), to_vec3(torque)};
  return true;
}

}  // namespace repel
