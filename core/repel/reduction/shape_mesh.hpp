// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Triangle meshes of shapes, for displays and simulated cameras. Set-up only: they allocate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <repel/geometry/facets.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/reduction/shape.hpp>

namespace repel {
namespace detail {

/// Directions over the sphere such that the support map finds every corner of a box, and rims at
/// regular angles.
/// @param turns directions around the axis; a quarter as many from pole to pole
inline std::vector<Vec3> mesh_directions(int turns) {
  std::vector<Vec3> all{{0, 0, 1}, {0, 0, -1}};
  const int rows = turns / 4;
  for (int row = 1; row < rows; ++row) {
    const double polar = std::numbers::pi * row / rows;
    // Half a step off the axes, where the support point of a box is not unique.
    for (int turn = 0; turn < turns; ++turn) {
      const double around = 2.0 * std::numbers::pi * (turn + 0.5) / turns;
      all.emplace_back(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                       std::cos(polar));
    }
  }
  return all;
}

inline void add_once(std::vector<Vec3>& points, const Vec3& p) {
  const auto is_same = [&](const Vec3& q) { return norm(p - q) < 1e-9; };
  if (std::none_of(points.begin(), points.end(), is_same)) points.push_back(p);
}

/// The vertices of a polytope, else the support points in all directions, each moved outward by
/// `radius`.
inline std::vector<Vec3> mesh_outline(const Convex& set, double radius, int turns) {
  std::vector<Vec3> points;
  if (set.is_polytope() && set.kind() == Convex::Kind::polytope && radius == 0.0) {
    for (int i = 0; i < set.vertex_count(); ++i) {
      add_once(points, to_vec3(set.place(static_cast<std::uint32_t>(i))));
    }
    return points;
  }
  for (Vec3 d : mesh_directions(turns)) {
    // Even on the unit ball whose image the ellipsoid is.
    if (set.kind() == Convex::Kind::ellipsoid) d = d.cwiseQuotient(to_vec3(set.round_size()));
    add_once(points, to_vec3(set.support(Vec<double>(d)).p) + radius * d);
  }
  return points;
}

/// The corners of the convex hull of points in a plane, counter-clockwise in the axes of the plane:
/// the lower chain from left to right, then the upper chain back.
inline std::vector<int> corners_in_plane(const std::vector<Vec3>& points, const Vec3& x,
                                         const Vec3& y) {
  const auto at = [&](int i) {
    const Vec3& p = points[static_cast<std::size_t>(i)];
    return std::pair(dot(x, p), dot(y, p));
  };
  const auto turns_left = [&](int a, int b, int c) {
    const auto [ax, ay] = at(a);
    const auto [bx, by] = at(b);
    const auto [cx, cy] = at(c);
    return (bx - ax) * (cy - by) > (by - ay) * (cx - bx);
  };
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto [ax, ay] = at(a);
    const auto [bx, by] = at(b);
    return ax != bx ? ax < bx : ay < by;
  });
  std::vector<int> corners;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = corners.size();
    for (const int i : order) {
      while (corners.size() >= begin + 2 && !turns_left(corners.end()[-2], corners.back(), i)) {
        corners.pop_back();
      }
      corners.push_back(i);
    }
    corners.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return corners;
}

/// Both sides of a planar set, as triangle fans; empty for a line.
inline std::vector<std::array<int, 3>> mesh_fan(const std::vector<Vec3>& points) {
  Vec3 middle(0, 0, 0);
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  Vec3 normal(0, 0, 0);
  Vec3 x(0, 0, 0);
  for (const Vec3& p : points) {
    for (const Vec3& q : points) {
      const Vec3 n = (p - middle).cross(q - middle);
      if (norm(n) <= norm(normal)) continue;
      normal = n;
      x = normalized(p - middle);
    }
  }
  const double size = std::sqrt(norm(normal));
  if (points.size() < 3 || size < 1e-6) return {};
  const std::vector<int> corners = corners_in_plane(points, x, normalized(normal).cross(x));
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i - 1], corners[i]});
    triangles.push_back({corners[0], corners[i], corners[i - 1]});
  }
  return triangles;
}

}  // namespace detail

/// The mesh of one reduction level [m] in the frame of the shape: for level 0 the shape itself, for
/// others the set eroded by their depth. Polytopes exactly, curved sets by chords: 48 corners per
/// rim on the first level, 24 on the others. A closed convex surface; for a set without volume its
/// points, and triangles if it is planar. Cost: up to a millisecond.
[[nodiscard]] inline TriangleMesh mesh_of(const Shape& shape, int level = 0) {
  const Level& chosen = shape.level(level);
  // The core of the first level is dilated by its depth: a sphere is a point with a radius.
  const bool is_first = level == 0;
  const std::vector<Vec3> points =
      detail::mesh_outline(chosen.core, is_first ? chosen.depth : 0.0, is_first ? 48 : 24);
  TriangleMesh mesh;
  const std::vector<Facet> facets = hull_facets({points.data(), points.size()});
  if (facets.empty()) return {points, detail::mesh_fan(points)};
  std::vector<int> index(points.size(), -1);
  for (const Facet& facet : facets) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      int& vertex = index[static_cast<std::size_t>(facet.vertices[k])];
      if (vertex < 0) {
        vertex = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(points[static_cast<std::size_t>(facet.vertices[k])]);
      }
      triangle[k] = vertex;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace repel
