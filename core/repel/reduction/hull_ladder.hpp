// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The ladder of an arbitrary convex hull. Set-up only: it allocates.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <repel/geometry/facets.hpp>
#include <repel/geometry/hull_faces.hpp>
#include <repel/geometry/planes.hpp>
#include <repel/geometry/vertex_scan.hpp>
#include <repel/reduction/ladder.hpp>

namespace repel::detail {

/// Least distance of x to the facet planes [m]: its depth in the hull, negative outside.
inline double depth_in(const std::vector<Facet>& facets, const Vec3& x) {
  double depth = std::numeric_limits<double>::infinity();
  for (const Facet& f : facets) depth = std::min(depth, f.offset - dot(f.n, x));
  return depth;
}

inline Vec3 centroid_of(std::span<const Vec3> vertices) {
  Vec3 sum{0, 0, 0};
  for (const Vec3& v : vertices) sum = sum + v / static_cast<double>(vertices.size());
  return sum;
}

/// A point near the deepest one: moves away from the nearest plane in steps of decreasing length.
/// The accuracy is not critical, since the depth of the result is measured afterwards.
inline Vec3 deep_point(const std::vector<Facet>& facets, std::span<const Vec3> vertices) {
  struct Nearest {
    const Facet* facet;
    double depth;
  };
  const auto nearest_to = [&](const Vec3& x) {
    Nearest nearest{&facets.front(), facets.front().offset - dot(facets.front().n, x)};
    for (const Facet& f : facets) {
      const double depth = f.offset - dot(f.n, x);
      if (depth < nearest.depth) nearest = {&f, depth};
    }
    return nearest;
  };
  Vec3 x = centroid_of(vertices);
  Vec3 best = x;
  Nearest nearest = nearest_to(x);
  double best_depth = nearest.depth;
  double step = best_depth;
  for (int i = 0; i < 400; ++i) {
    x = x - step * nearest.facet->n;
    nearest = nearest_to(x);
    if (nearest.depth > best_depth) {
      best = x;
      best_depth = nearest.depth;
    } else {
      step *= 0.97;
    }
  }
  return best;
}

/// A point at least `t` inside every plane, close to `v`: cyclic projections onto the planes moved
/// in by `t` (Dykstra without memory), then a step toward `deep`, which is inside. Only nearby
/// planes take part in the projections.
inline Vec3 moved_inside(const std::vector<Facet>& facets, Vec3 v, double t, const Vec3& deep) {
  std::vector<Facet> nearby;
  for (const Facet& f : facets) {
    if (f.offset - dot(f.n, v) < 2.0 * t) nearby.push_back(f);
  }
  bool moved = true;
  for (int sweep = 0; sweep < 60 && moved; ++sweep) {
    moved = false;
    for (const Facet& f : nearby) {
      const double excess = dot(f.n, v) - (f.offset - t);
      if (excess <= 0.0) continue;
      v = v - excess * f.n;
      moved = true;
    }
  }
  double share = 0.0;
  for (const Facet& f : facets) {
    const double excess = dot(f.n, v) - (f.offset - t);
    const double room = (f.offset - t) - dot(f.n, deep);
    if (excess > 0.0 && room > 0.0) share = std::max(share, excess / (excess + room));
    if (excess > 0.0 && room <= 0.0) return deep;
  }
  return v + std::min(1.0, share * (1.0 + 1e-12)) * (deep - v);
}

/// With more than a thousand corners, moves the extreme ones along about a thousand directions all
/// around to the front. Returns their number, or the number of all corners when there are fewer.
inline std::size_t lead_with_extremes(std::vector<Vec3>& corners) {
  constexpr int steps = leading_steps;
  if (corners.size() <= most_leading) return corners.size();
  const VertexScan all({corners.data(), corners.size()});
  std::vector<char> leads(corners.size());
  const auto along = [](int step) { return (2.0 * step + 1.0) / steps - 1.0; };
  for (int i = 0; i < static_cast<int>(most_leading); ++i) {
    Vec3 d;
    d[i % 3] = i % 2 == 0 ? 1.0 : -1.0;
    d[(i + 1) % 3] = along(i / 6 % steps);
    d[(i + 2) % 3] = along(i / 6 / steps);
    leads[all.scan(Vec<double>(d))] = 1;
  }
  std::vector<Vec3> rest;
  std::size_t count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (leads[i] != 0) {
      corners[count++] = corners[i];
    } else {
      rest.push_back(corners[i]);
    }
  }
  for (std::size_t i = 0; i < rest.size(); ++i) corners[count + i] = rest[i];
  return count;
}

/// The ladder whose first level is `hull`, with these vertices and facets.
///
/// For the next level, each vertex moves to the nearest point found `t` deeper; the next level is
/// the hull of the moved vertices. So no level has more vertices than its parent, a vertex keeps
/// its index from level to level, and the depth of a level is the sum of the measured depth gains
/// of all steps. Of a hull with very many vertices only the first `leading` move, a thousand. The
/// last level with volume is followed by its centroid, and so is flat input: it has no depth.
inline Ladder hull_ladder(Convex hull, std::vector<Vec3> vertices, std::size_t leading,
                          const ReductionOptions& options, std::vector<Facet> facets) {
  std::vector<Vec3> sides;
  sides.reserve(facets.size());
  for (const Facet& f : facets) sides.push_back(f.n);
  Ladder ladder = ladder_of(std::move(hull));
  const std::span<const Vec3> moving(vertices.data(), leading);
  Vec3 centroid = centroid_of(moving);
  double depth = 0.0;
  double taken = 0.0;
  for (int i = 1; i <= options.levels && !facets.empty(); ++i) {
    const Vec3 deep = deep_point(facets, moving);
    const double room = depth_in(facets, deep);
    if (!(room > 0.0)) break;
    const double next = even_steps(i, options);
    const double target =
        i == options.levels ? 0.95 * room : room * (next - taken) / (options.levels - taken);
    taken = next;
    double won = room;
    for (std::size_t k = 0; k < leading; ++k) {
      vertices[k] = moved_inside(facets, vertices[k], target, deep);
      won = std::min(won, depth_in(facets, vertices[k]));
    }
    // Subtracts a bound of the rounding error from the claimed depth.
    won -= 1e-12 * ladder.front().core.reach();
    if (!(won > 0.0)) break;
    depth += won;
    append(ladder, Convex::polytope(moving), depth, depth);
    centroid = centroid_of(moving);
    facets = hull_facets(moving);
  }
  if (vertices.size() > 1) {
    append(ladder, Convex::polytope({&centroid, 1}), depth, flat_order);
  }
  return verified(std::move(ladder), {sides.data(), sides.size()});
}

/// The ladder of the hull of `points` with these facets; the first level has the vertices only.
inline Ladder hull_ladder(std::span<const Vec3> points, const ReductionOptions& options,
                          std::vector<Facet> facets) {
  std::vector<Vec3> vertices(points.begin(), points.end());
  if (!facets.empty()) vertices = hull_corners(points, facets);
  const std::size_t leading = lead_with_extremes(vertices);
  const std::span<const Vec3> all(vertices.data(), vertices.size());
  Convex hull = Convex::polytope(all, hull_faces(points, facets, all));
  return hull_ladder(std::move(hull), std::move(vertices), leading, options, std::move(facets));
}

/// The ladder of that hull, a polytope, with its vertices in their order.
inline Ladder hull_ladder(const Convex& hull, const ReductionOptions& options) {
  std::vector<Vec3> vertices;
  vertices.reserve(static_cast<std::size_t>(hull.vertex_count()));
  for (int i = 0; i < hull.vertex_count(); ++i) {
    vertices.push_back(to_vec3(hull.place(static_cast<std::uint32_t>(i))));
  }
  std::vector<Vec3> led = vertices;
  const std::size_t leading = lead_with_extremes(led);
  std::vector<Facet> facets = hull_facets({vertices.data(), vertices.size()});
  return hull_ladder(hull, std::move(vertices), leading, options, std::move(facets));
}

/// [m] The radius of the largest ball found in the hull of `points` with these facets; 0 for a flat
/// one.
inline double hull_inscribed_radius(std::span<const Vec3> points,
                                    const std::vector<Facet>& facets) {
  return facets.empty() ? 0.0 : std::max(0.0, depth_in(facets, deep_point(facets, points)));
}

/// The planes of the hull of `points` with these facets. Planes with an offset error d enclose at
/// most the hull scaled by 1 + d / r about the centre of an inscribed ball of that radius r [m]; at
/// the tip of a sliver this reaches far outside the hull.
inline Planes hull_planes(std::span<const Vec3> points, const std::vector<Facet>& facets,
                          double radius) {
  if (facets.empty()) return Planes();
  double reach = 0.0;
  for (const Vec3& p : points) reach = std::max(reach, norm(p));
  const double off = 4e-15 * reach;
  const double sharpness = 1.0 + 2.0 * reach / std::max(radius, off);
  return Planes(facets, off * sharpness, sharpness);
}

inline Ladder hull_ladder(std::span<const Vec3> points, const ReductionOptions& options) {
  return hull_ladder(points, options, hull_facets(points));
}

}  // namespace repel::detail
