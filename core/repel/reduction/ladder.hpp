// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The ladder of nested sub-shapes by which overlap is measured (Anderson 1993, section 2.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/convex.hpp>

namespace repel {

/// How a shape is reduced.
struct ReductionOptions {
  static constexpr int most_levels = 64;  ///< of one shape

  int levels = 8;  ///< steps until the shape has lost its thickness; 1 to `most_levels`
  /// The first i of n steps take (i/n)^spacing of the thickness: 1 makes the steps even, a larger
  /// value concentrates them below the surface, a smaller one around the core; 0.25 to 4.
  double spacing = 1.0;
};

/// One sub-shape: every point of `core` lies at least `depth` inside the shape.
struct Level {
  Convex core;         ///< the sub-shape
  double depth = 0.0;  ///< [m]
  double order = 0.0;  ///< position among the levels of another shape, see Ladder
};

/// The levels of one shape: A_0 first, a point last, with
///
///     A_i+1 + Ball(depth_i+1 - depth_i) inside A_i      and      A_0 + Ball(depth_0) = the shape,
///
/// so that rounding (a sphere is a point with a depth) is treated as any other depth. Two ladders
/// are merged by `order`: by the depth lost while there is thickness to lose, and after that by how
/// far the flat remains have shrunk. The merged pairs are nested, as needed by the walk along them;
/// see separation.hpp.
using Ladder = std::vector<Level>;

namespace detail {

/// Flat levels are ordered after every level that still gains depth, of either shape.
inline constexpr double flat_order = 1e9;

/// [byte] Heap memory held.
[[nodiscard]] inline std::size_t bytes_of(const Ladder& ladder) noexcept {
  std::size_t bytes = ladder.capacity() * sizeof(Level);
  for (const Level& level : ladder) bytes += level.core.bytes();
  return bytes;
}

/// [byte] Upper bound of the memory of a ladder without polytopes: the shape, its levels, a line
/// and a point.
[[nodiscard]] inline std::size_t most_ladder_bytes(const ReductionOptions& options) noexcept {
  return (static_cast<std::size_t>(options.levels) + 3) * sizeof(Level) + Convex::most_bytes(1);
}

/// Number of sample directions, all around, whose extreme vertices lead in a hull with very many
/// vertices.
inline constexpr int leading_steps = 13;  ///< along an edge of a cube around the origin
inline constexpr std::size_t most_leading = std::size_t{6} * leading_steps * leading_steps;

/// [byte] Upper bound of the memory of the ladder of so many points, if all are vertices: no level
/// has more vertices than its parent.
[[nodiscard]] inline std::size_t most_ladder_bytes(std::size_t points,
                                                   const ReductionOptions& options) noexcept {
  const std::size_t moving = std::min(points, most_leading);
  return most_ladder_bytes(options) + Convex::most_bytes(points) + Faces::most_bytes(points) +
         static_cast<std::size_t>(options.levels) * Convex::most_bytes(moving);
}

/// A ladder of one level.
inline Ladder ladder_of(Convex core, double depth = 0.0) {
  Ladder ladder;
  ladder.push_back({std::move(core), depth, 0.0});
  return ladder;
}

/// Adds a level, ordered strictly after the last one: the walk along the chain fails when rounding
/// makes orders equal.
inline void append(Ladder& ladder, Convex core, double depth, double order) {
  const double next = std::nextafter(ladder.back().order, std::numeric_limits<double>::infinity());
  ladder.push_back({std::move(core), depth, std::max(order, next)});
}

/// The number of even steps equivalent to the first `i` steps, 1 to all: `i` itself if all are
/// even.
inline double even_steps(int i, const ReductionOptions& options) {
  return i * std::pow(static_cast<double>(i) / options.levels, options.spacing - 1.0);
}

/// [m] Depth after the first `i` steps into a shape of that thickness [m].
inline double depth_after(int i, const ReductionOptions& options, double thickness) {
  if (i == options.levels) return thickness;
  return thickness * even_steps(i, options) / options.levels;
}

/// The ladder with the depth of each level lowered to the proof by its support values. Along each
/// of `normals`, a level must lie inside the first level by its depth and inside its parent by its
/// step. That holds within 4e-15 of the reach, less than the margin of queries.
/// @param normals of all sides of the first level; one of each pair if all levels are symmetric,
/// one for a curved side around the axis Throws SetupError for a level protruding from its parent
/// beyond 1e-12 of the reach. Cost: a support map per level and normal.
inline Ladder verified(Ladder ladder, std::span<const Vec3> normals) {
  const double reach = ladder.front().core.reach();
  // Squares of lengths below 1e-154 m lose all digits by underflow.
  const double rounding = 4e-15 * reach + 1e-150;
  std::vector<double> outermost;
  for (const Vec3& n : normals) {
    outermost.push_back(ladder.front().core.support_value(Vec<double>(n)));
  }
  std::vector<double> before = outermost;
  for (std::size_t k = 1; k < ladder.size(); ++k) {
    double in_shape = std::numeric_limits<double>::infinity();
    double in_parent = in_shape;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double here = ladder[k].core.support_value(Vec<double>(normals[i]));
      in_shape = std::min(in_shape, outermost[i] - here);
      in_parent = std::min(in_parent, before[i] - here);
      before[i] = here;
    }
    if (in_parent < -1e-12 * reach - rounding) {
      throw SetupError("a level reaches out of the one before it");
    }
    const double parent = ladder[k - 1].depth;
    const double shown =
        std::min(ladder.front().depth + in_shape, parent + std::max(0.0, in_parent)) + rounding;
    ladder[k].depth = std::max(parent, std::min(ladder[k].depth, shown));
  }
  return ladder;
}

/// A box is reduced by its thickness to a rectangle, the rectangle by its width to a line, the line
/// by its length to a point (Figure 4 a, b, c). Steps that coincide are merged.
inline Ladder box_ladder(const Vec3& half_extents, const ReductionOptions& options) {
  Vec3 sorted = half_extents;
  if (sorted[1] < sorted[0]) std::swap(sorted[0], sorted[1]);
  if (sorted[2] < sorted[1]) std::swap(sorted[1], sorted[2]);
  if (sorted[1] < sorted[0]) std::swap(sorted[0], sorted[1]);
  const auto eroded = [&](double t) -> Vec3 {
    return {std::max(half_extents[0] - t, 0.0), std::max(half_extents[1] - t, 0.0),
            std::max(half_extents[2] - t, 0.0)};
  };
  Ladder ladder = ladder_of(Convex::box(half_extents));
  for (int i = 1; i <= options.levels && sorted[0] > 0.0; ++i) {
    const double t = depth_after(i, options, sorted[0]);
    append(ladder, Convex::box(eroded(t)), t, t);
  }
  for (const double t : {sorted[1], sorted[2]}) {
    if (ladder.back().core.vertex_count() == 1 || t == sorted[0]) continue;
    if (t == sorted[1] && sorted[1] == sorted[2] && ladder.back().order > flat_order) continue;
    append(ladder, Convex::box(eroded(t)), sorted[0], flat_order + t);
  }
  const Vec3 sides[] = {unit(0), unit(1), unit(2)};
  return verified(std::move(ladder), {sides, 3});
}

/// `verified` for sets around the z axis with equal ends.
inline Ladder verified_around_z(Ladder ladder) {
  const Vec3 side_and_end[] = {unit(0), unit(2)};
  return verified(std::move(ladder), {side_and_end, 2});
}

/// A long cylinder shrinks to its axis and then to a point; a flat one to a thin disc and then to a
/// point (Figure 4 e, f).
inline Ladder cylinder_ladder(double radius, double half_length, const ReductionOptions& options) {
  const double thickness = std::min(radius, half_length);
  const double rest = std::max(radius, half_length);
  Ladder ladder = ladder_of(Convex::cylinder(radius, half_length));
  for (int i = 1; i <= options.levels && thickness > 0.0; ++i) {
    const double t = depth_after(i, options, thickness);
    append(ladder, Convex::cylinder(radius - t, half_length - t), t, t);
  }
  if (rest > thickness) {
    append(ladder, Convex::box({0, 0, 0}), thickness, flat_order + rest);
  }
  return verified_around_z(std::move(ladder));
}

/// A cone keeps its opening angle and shrinks to the centre of its inscribed ball: moved in by t,
/// the base rises by t and the apex falls by t / sin(a), a the angle between axis and side.
inline Ladder cone_ladder(double radius, double half_length, const ReductionOptions& options) {
  const double length = 2.0 * half_length;
  const double side = std::hypot(radius, length);
  Ladder ladder = ladder_of(Convex::cone(radius, -half_length, half_length));
  // The radius of the inscribed ball.
  const double thickness = radius > 0.0 ? length * radius / (side + radius) : 0.0;
  for (int i = 1; i < options.levels && thickness > 0.0; ++i) {
    const double t = depth_after(i, options, thickness);
    const double scale = 1.0 - even_steps(i, options) / options.levels;
    const double base = t - half_length;
    append(ladder, Convex::cone(scale * radius, base, base + scale * length), t, t);
  }
  if (radius > 0.0 || length > 0.0) {
    const Vec3 centre{0.0, 0.0, thickness > 0.0 ? thickness - half_length : 0.0};
    append(ladder, Convex::polytope({&centre, 1}), thickness,
           thickness > 0.0 ? thickness : flat_order + std::max(radius, half_length));
  }
  const Vec3 base_and_side[] = {-unit(2), direction_of({length, 0.0, radius})};
  return verified(std::move(ladder), {base_and_side, 2});
}

/// An ellipsoid shrinks to its centre. With c the least semi-axis, the level at depth t has the
/// squares (c - t)^2 + (1 - t / c) (a^2 - c^2) of the semi-axes a: the same radii of curvature at
/// the ends of the least axis, less t. So its support function is less by t there, and by more
/// elsewhere. That it loses nothing more at these ends makes the levels of a flat one nearly as
/// wide as the shape.
inline Ladder ellipsoid_ladder(const Vec3& semi_axes, const ReductionOptions& options) {
  int thin = 0;
  for (int axis = 1; axis < 3; ++axis) thin = semi_axes[axis] < semi_axes[thin] ? axis : thin;
  const double least = semi_axes[thin];
  Ladder ladder = ladder_of(Convex::ellipsoid(semi_axes));
  for (int i = 1; i < options.levels; ++i) {
    const double t = depth_after(i, options, least);
    const double left = 1.0 - t / least;
    Vec3 level;
    for (int axis = 0; axis < 3; ++axis) {
      const double more = (semi_axes[axis] - least) * (semi_axes[axis] + least);
      level[axis] = std::sqrt((least - t) * (least - t) + left * more);
    }
    level[thin] = least - t;
    append(ladder, Convex::ellipsoid(level), t, t);
  }
  append(ladder, Convex::box({0, 0, 0}), least, least);
  const Vec3 ends[] = {unit(thin)};
  return verified(std::move(ladder), {ends, 1});
}

/// A sphere is a point with a depth (Figure 4 d).
inline Ladder sphere_ladder(double radius) {
  return ladder_of(Convex::box({0, 0, 0}), radius);
}

/// A capsule is a segment with a depth, then a point with the same depth.
inline Ladder capsule_ladder(double radius, double half_length) {
  Ladder ladder = ladder_of(Convex::box({0.0, 0.0, half_length}), radius);
  if (half_length > 0.0) {
    append(ladder, Convex::box({0, 0, 0}), radius, flat_order + half_length);
  }
  return verified_around_z(std::move(ladder));
}

}  // namespace detail
}  // namespace repel
