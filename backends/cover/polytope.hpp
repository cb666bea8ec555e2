// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Convex polytopes cut by planes. Set-up only: they allocate.
#pragma once

#include <span>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::cover {

/// The points with n.x <= offset.
struct HalfSpace {
  Vec3 n{0, 0, 1};      ///< unit, outward
  double offset = 0.0;  ///< [m]

  /// [m] positive outside
  [[nodiscard]] double height(const Vec3& p) const { return n.dot(p) - offset; }
};

/// A convex polygon as its corners in order.
using Polygon = std::vector<Vec3>;

/// The least and the largest height of points above the plane of a half space [m].
struct HeightRange {
  double low = 0.0;
  double high = 0.0;
};
[[nodiscard]] HeightRange heights(std::span<const Vec3> points, const HalfSpace& plane);

/// The crossing of the line from a to b with a plane, `ha` and `hb` their heights above it, one
/// negative: the same to the bit if both are exchanged, so neighbours share corners.
[[nodiscard]] Vec3 crossing(const Vec3& a, double ha, const Vec3& b, double hb);

/// Calls visit(p, height) for each corner of the polygon, and between two on different sides of the
/// plane for their crossing, at height zero.
template <class Visit>
void for_each_corner(const Polygon& polygon, const HalfSpace& plane, const Visit& visit) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double ha = plane.height(a);
    const double hb = plane.height(b);
    visit(a, ha);
    if ((ha < 0.0 && hb > 0.0) || (ha > 0.0 && hb < 0.0)) visit(crossing(a, ha, b, hb), 0.0);
  }
}

/// The part of `polygon` in the half space; fewer than three corners if there is none.
[[nodiscard]] Polygon clipped(const Polygon& polygon, const HalfSpace& plane);

/// A bounded convex polytope as its faces. One without faces is empty.
class Polytope {
 public:
  [[nodiscard]] static Polytope box(const Vec3& low, const Vec3& high);
  /// The hull of `points`; empty if all of them are in one plane.
  [[nodiscard]] static Polytope hull(std::span<const Vec3> points);

  [[nodiscard]] bool empty() const { return faces_.empty(); }
  /// The corners, each once.
  [[nodiscard]] std::vector<Vec3> corners() const;
  /// The intersection with the half space. Cost: one pass over the corners.
  [[nodiscard]] Polytope clipped(const HalfSpace& plane) const;

 private:
  std::vector<Polygon> faces_;
};

/// A convex part of a cover: the hull of its vertices.
struct ConvexPart {
  std::vector<Vec3> vertices;     ///< [m] the corners of the hull
  std::vector<Polygon> facets;    ///< triangles
  std::vector<HalfSpace> planes;  ///< of the facets, each once
  Vec3 low{0, 0, 0}, high{0, 0, 0};

  /// The hull of `points`; for more than 100 000, a convex set of some hundred corners containing
  /// every point. A set in one plane is made `thickness` [m] thick; without planes if the points
  /// are in one line.
  [[nodiscard]] static ConvexPart of(std::span<const Vec3> points, double thickness);

  /// Whether p is inside every plane, or above it by at most `margin` [m].
  [[nodiscard]] bool contains(const Vec3& p, double margin) const;
  /// The distance of p, 0 inside [m]. Cost: proportional to the facets.
  [[nodiscard]] double distance(const Vec3& p) const;
  [[nodiscard]] double volume() const;  ///< [m^3]
};

/// The largest distance of points from `triangle` [m]: of any point of their hull, as the distance
/// from a convex set is a convex function.
[[nodiscard]] double largest_distance(std::span<const Vec3> points, std::span<const Vec3> triangle);

/// The point of the triangle a b c nearest to p.
[[nodiscard]] Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace repel::cover
