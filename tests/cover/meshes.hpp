// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Meshes whose solids are known.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <repel/geometry/triangle_mesh.hpp>

namespace repel::test {

/// Two triangles of a quadrilateral that its outside sees counter-clockwise.
inline void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c,
                     const Vec3& d) {
  const int i = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.triangles.push_back({i, i + 1, i + 2});
  mesh.triangles.push_back({i, i + 2, i + 3});
}

/// A prism over a polygon that is seen counter-clockwise from above; its ends are fans, so the
/// polygon is convex, or seen whole from its first corner.
inline TriangleMesh prism(const std::vector<std::array<double, 2>>& outline, double height) {
  TriangleMesh mesh;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, height}) {
    for (const auto& p : outline) mesh.vertices.emplace_back(p[0], p[1], z);
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
    if (i > 0 && j > 0) {
      mesh.triangles.push_back({0, j, i});
      mesh.triangles.push_back({n, n + i, n + j});
    }
  }
  return mesh;
}

/// A box with a corner at the origin [m].
inline TriangleMesh box_mesh(const Vec3& size) {
  return prism({{0, 0}, {size.x(), 0}, {size.x(), size.y()}, {0, size.y()}}, size.z());
}

/// An L of two legs, both `width` wide, 0.2 m long and high [m].
inline TriangleMesh angle_mesh(double width, double height) {
  return prism({{width, width}, {width, 0.2}, {0, 0.2}, {0, 0}, {0.2, 0}, {0.2, width}}, height);
}

/// A bin that is open above: outside 0.2 x 0.15 x 0.1 m, walls and bottom 10 mm.
struct Bin {
  static constexpr double wall = 0.01;
  Vec3 size{0.2, 0.15, 0.1};

  [[nodiscard]] TriangleMesh mesh() const {
    TriangleMesh mesh;
    const auto at = [&](int corner, bool is_inner, double z) {
      const double t = is_inner ? wall : 0.0;
      const bool right = corner == 1 || corner == 2;
      return Vec3(right ? size.x() - t : t, corner >= 2 ? size.y() - t : t, z);
    };
    const double top = size.z();
    add_quad(mesh, at(0, false, 0), at(3, false, 0), at(2, false, 0), at(1, false, 0));
    add_quad(mesh, at(0, true, wall), at(1, true, wall), at(2, true, wall), at(3, true, wall));
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      add_quad(mesh, at(i, false, 0), at(j, false, 0), at(j, false, top), at(i, false, top));
      add_quad(mesh, at(j, true, wall), at(i, true, wall), at(i, true, top), at(j, true, top));
      add_quad(mesh, at(i, false, top), at(j, false, top), at(j, true, top), at(i, true, top));
    }
    return mesh;
  }

  /// The distance of p, 0 inside [m]: from the bottom and four walls, which are boxes.
  [[nodiscard]] double distance(const Vec3& p) const {
    const auto from = [&](const Vec3& low, const Vec3& high) {
      return Vec3((low - p).cwiseMax(p - high).cwiseMax(0.0)).norm();
    };
    const Vec3 inner = size - Vec3(wall, wall, 0);
    return std::min({from({0, 0, 0}, {size.x(), size.y(), wall}),
                     from({0, 0, 0}, {wall, size.y(), size.z()}), from({inner.x(), 0, 0}, size),
                     from({0, 0, 0}, {size.x(), wall, size.z()}), from({0, inner.y(), 0}, size)});
  }
};

/// A ring around the z axis with a square section: radii 40 and 60 mm, 20 mm high, of `n` sides.
inline TriangleMesh ring_mesh(int n) {
  TriangleMesh mesh;
  const auto at = [&](int i, double r, double z) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    return Vec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    add_quad(mesh, at(i, 0.06, 0), at(j, 0.06, 0), at(j, 0.06, 0.02), at(i, 0.06, 0.02));
    add_quad(mesh, at(j, 0.04, 0), at(i, 0.04, 0), at(i, 0.04, 0.02), at(j, 0.04, 0.02));
    add_quad(mesh, at(i, 0.06, 0.02), at(j, 0.06, 0.02), at(j, 0.04, 0.02), at(i, 0.04, 0.02));
    add_quad(mesh, at(j, 0.06, 0), at(i, 0.06, 0), at(i, 0.04, 0), at(j, 0.04, 0));
  }
  return mesh;
}

}  // namespace repel::test
