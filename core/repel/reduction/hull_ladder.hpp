/// @file
/// The ladder of an arbitrary convex hull. Set-up only: it allocates.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <repel/geometry/facets.hpp>
#include <repel/reduction/ladder.hpp>

namespace repel::detail {

/// Least distance of x to the facet planes [m]: its depth in the hull, negative outside.
inline double depth_in(const std::vector<Facet>& facets, const Vec3& x) {
  double depth = std::numeric_limits<double>::infinity();
  for (const Facet& f : facets) depth = std::min(depth, f.offset - f.n.dot(x));
  return depth;
}

inline Vec3 centroid_of(std::span<const Vec3> vertices) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : vertices) sum += v / static_cast<double>(vertices.size());
  return sum;
}

/// A point near the deepest one: walks away from the nearest plane in steps that shrink. Whatever
/// it finds is honest, since its depth is measured afterwards.
inline Vec3 deep_point(const std::vector<Facet>& facets, std::span<const Vec3> vertices) {
  Vec3 x = centroid_of(vertices);
  Vec3 best = x;
  double best_depth = depth_in(facets, x);
  double step = best_depth;
  for (int i = 0; i < 400; ++i) {
    const Facet* nearest = &facets.front();
    for (const Facet& f : facets) {
      if (f.offset - f.n.dot(x) < nearest->offset - nearest->n.dot(x)) nearest = &f;
    }
    x -= step * nearest->n;
    const double depth = depth_in(facets, x);
    if (depth > best_depth) {
      best = x;
      best_depth = depth;
    } else {
      step *= 0.97;
    }
  }
  return best;
}

/// A point at least `t` inside every plane, close to `v`: sweeps of projections onto the planes
/// moved in by `t` (Dykstra without memory), then a slide toward `deep`, which is inside.
inline Vec3 moved_inside(const std::vector<Facet>& facets, Vec3 v, double t, const Vec3& deep,
                         int sweeps) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool moved = false;
    for (const Facet& f : facets) {
      const double excess = f.n.dot(v) - (f.offset - t);
      if (excess <= 0.0) continue;
      v -= excess * f.n;
      moved = true;
    }
    if (!moved) break;
  }
  double share = 0.0;
  for (const Facet& f : facets) {
    const double excess = f.n.dot(v) - (f.offset - t);
    const double room = (f.offset - t) - f.n.dot(deep);
    if (excess > 0.0 && room > 0.0) share = std::max(share, excess / (excess + room));
    if (excess > 0.0 && room <= 0.0) return deep;
  }
  return v + std::min(1.0, share * (1.0 + 1e-12)) * (deep - v);
}

/// Each vertex of a level moves to the nearest point it finds that is `t` deeper; the hull of the
/// moved vertices is the next level. So no level has more vertices than its parent, a vertex keeps
/// its index from level to level, and the depth of a level is the sum of what each step is measured
/// to have won. The last solid level goes to its centroid, and so does flat input, which has no
/// depth.
inline Ladder hull_ladder(std::span<const Vec3> points, int levels) {
  std::vector<Vec3> vertices(points.begin(), points.end());
  Ladder ladder{{Convex::polytope(vertices), 0.0, 0.0}};
  Vec3 centroid = centroid_of(vertices);
  double depth = 0.0;
  for (int i = 0; i < levels; ++i) {
    const std::vector<Facet> facets = hull_facets(vertices);
    if (facets.empty()) break;
    const Vec3 deep = deep_point(facets, vertices);
    const double room = depth_in(facets, deep);
    if (!(room > 0.0)) break;
    const bool last = i + 1 == levels;
    const double target = last ? 0.95 * room : room / (levels - i);
    const int sweeps = static_cast<int>(std::clamp(
        2e7 / (static_cast<double>(vertices.size() * facets.size()) * levels), 1.0, 60.0));
    double won = room;
    for (Vec3& v : vertices) {
      v = moved_inside(facets, v, target, deep, sweeps);
      won = std::min(won, depth_in(facets, v));
    }
    // What rounding may have cost is taken off the claim.
    won -= 1e-12 * ladder.front().core.reach();
    if (!(won > 0.0)) break;
    depth += won;
    append(ladder, Convex::polytope(vertices), depth, depth);
    centroid = centroid_of(vertices);
  }
  if (points.size() > 1) {
    append(ladder, Convex::polytope(std::span(&centroid, 1)), depth, flat_order);
  }
  return ladder;
}

}  // namespace repel::detail
