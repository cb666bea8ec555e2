// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The surface of the convex hull of a set of points, as triangles. Set-up only: it allocates.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <repel/geometry/orientation.hpp>

namespace repel::detail {

/// Quickhull (Barber, Dobkin, Huhdanpaa 1996): every outside point is assigned to one visible
/// facet; the farthest point of a facet replaces all facets it sees by a cone over their horizon.
///
/// A facet sees a point strictly above it, decided exactly. So the facets seeing a point are
/// connected and their horizon is a single cycle. A point is never collinear with its horizon edge,
/// and points in the plane of a facet give further facets in that plane.
class QuickHull {
 public:
  struct Face {
    std::array<int, 3> vertices{};   ///< counter-clockwise seen from outside
    std::array<int, 3> neighbors{};  ///< face beyond the edge from vertex k to the one after it
    Vec3 n{0, 0, 0};                 ///< unit, outward
    std::vector<int> outside;        ///< points assigned to this face, the farthest last
    double farthest = 0.0;           ///< height of the last of them above the face
    bool gone = false;
  };

  /// For finite points [m].
  explicit QuickHull(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    double size = 0.0;
    for (const Vec3& p : points_) size = std::max(size, largest_entry(p));
    // Scaled by a power of two, with coordinates below 5e-91 of the size set to 0, so that no
    // product underflows and all decisions are exact.
    const int exponent = size > 0.0 ? std::ilogb(size) : 0;
    for (Vec3& p : points_) {
      for (int k = 0; k < 3; ++k) {
        p[k] = std::ldexp(p[k], -exponent);
        if (std::abs(p[k]) < 0x1p-300) p[k] = 0.0;
      }
    }
  }

  /// Empty when all points lie within 1e-14 of their largest coordinate from one plane.
  [[nodiscard]] std::vector<Face> build() {
    if (points_.size() < 4 || !start()) return {};
    rim_face_.assign(points_.size(), -1);
    // New faces are appended, so one pass visits all.
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (faces_[i].gone || faces_[i].outside.empty()) continue;
      add(faces_[i].outside.back(), static_cast<int>(i));
    }
    std::vector<Face> left;
    for (Face& f : faces_) {
      if (!f.gone) left.push_back(std::move(f));
    }
    return left;
  }

 private:
  struct RimEdge {
    int from = 0;
    int to = 0;
    int beyond = 0;  ///< the face on the other side, which stays
    int slot = 0;    ///< index of the edge in that face
  };

  static constexpr double flat = 1e-14;
  static constexpr double rounding = 8e-15;  ///< error of a height, a generous bound

  bool start();
  void push(int a, int b, int c, const std::array<int, 3>& neighbors);
  void add(int apex, int first_seen);
  void find_rim(int apex, int first_seen);
  void close_rim(int apex);

  /// The point with the largest measure; of several equal ones the lexicographically last, a vertex
  /// of their hull.
  template <class Measure>
  [[nodiscard]] int farthest(Measure measure) const {
    std::size_t best = 0;
    double most = measure(points_[0]);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double here = measure(points_[i]);
      if (here < most || (here == most && !after(points_[i], points_[best]))) continue;
      best = i;
      most = here;
    }
    return static_cast<int>(best);
  }
  [[nodiscard]] static bool after(const Vec3& p, const Vec3& q) {
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return p[k] > q[k];
    }
    return false;
  }

  [[nodiscard]] double height(const Face& f, int i) const {
    return dot(f.n, points_[i] - points_[f.vertices[0]]);
  }
  [[nodiscard]] bool sees(const Face& f, int i, double height_of_i) const {
    if (std::abs(height_of_i) > rounding) return height_of_i > 0.0;
    const auto& [a, b, c] = f.vertices;
    return orientation(points_[a], points_[b], points_[c], points_[i]) > 0;
  }

  /// Assigns point i to the first face from `begin` on that sees it. A point that none sees is
  /// inside.
  void assign(int i, std::size_t begin) {
    for (std::size_t k = begin; k < faces_.size(); ++k) {
      Face& f = faces_[k];
      const double h = height(f, i);
      if (!sees(f, i, h)) continue;
      f.outside.push_back(i);
      const std::size_t count = f.outside.size();
      if (count > 1 && (h < f.farthest ||
                        (h == f.farthest && !after(points_[i], points_[f.outside[count - 2]])))) {
        std::swap(f.outside[count - 1], f.outside[count - 2]);
      } else {
        f.farthest = h;
      }
      return;
    }
  }

  std::vector<Vec3> points_;  ///< scaled to about 1
  std::vector<Face> faces_;
  std::vector<RimEdge> rim_;
  std::vector<int> seen_;      ///< faces seeing the apex, to be removed
  std::vector<int> rim_face_;  ///< for each point, the new face on the rim edge that starts there
};

inline void QuickHull::push(int a, int b, int c, const std::array<int, 3>& neighbors) {
  faces_.push_back({{a, b, c}, neighbors, plane_normal(points_[a], points_[b], points_[c]), {}});
}

/// The initial tetrahedron: each vertex is the farthest from the span of those before it. False
/// when there is none.
inline bool QuickHull::start() {
  const int o = farthest([](const Vec3& p) { return p.x(); });
  const Vec3 origin = points_[o];
  int a = farthest([&](const Vec3& p) { return squared_norm(p - origin); });
  const Vec3 along = normalized(points_[a] - origin);
  const auto from_line = [&](const Vec3& p) { return norm((p - origin).cross(along)); };
  int b = farthest(from_line);
  if (!(from_line(points_[b]) > flat)) return false;
  const Vec3 n = plane_normal(origin, points_[a], points_[b]);
  const int top = farthest([&](const Vec3& p) { return std::abs(dot(p - origin, n)); });
  const double height_of_top = dot(points_[top] - origin, n);
  if (!(std::abs(height_of_top) > flat)) return false;
  if (height_of_top > 0.0) std::swap(a, b);
  push(o, a, b, {1, 2, 3});
  push(o, top, a, {3, 2, 0});
  push(a, top, b, {1, 3, 0});
  push(b, top, o, {2, 1, 0});
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) assign(i, 0);
  return true;
}

inline void QuickHull::add(int apex, int first_seen) {
  find_rim(apex, first_seen);
  const std::size_t begin = faces_.size();
  close_rim(apex);
  for (const int f : seen_) {
    for (const int i : std::exchange(faces_[f].outside, {})) {
      if (i != apex) assign(i, begin);
    }
  }
}

inline void QuickHull::find_rim(int apex, int first_seen) {
  rim_.clear();
  seen_.assign(1, first_seen);
  faces_[first_seen].gone = true;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const Face& f = faces_[seen_[k]];
    for (int edge = 0; edge < 3; ++edge) {
      Face& beyond = faces_[f.neighbors[edge]];
      if (beyond.gone) continue;
      if (sees(beyond, apex, height(beyond, apex))) {
        beyond.gone = true;
        seen_.push_back(f.neighbors[edge]);
      }
    }
  }
  for (const int seen : seen_) {
    const Face& f = faces_[seen];
    for (int edge = 0; edge < 3; ++edge) {
      const Face& beyond = faces_[f.neighbors[edge]];
      if (beyond.gone) continue;
      const int to = f.vertices[(edge + 1) % 3];
      int slot = 0;
      while (slot < 2 && beyond.vertices[slot] != to) ++slot;
      rim_.push_back({f.vertices[edge], to, f.neighbors[edge], slot});
    }
  }
}

/// Joins the edges of the rim (horizon) to the apex.
inline void QuickHull::close_rim(int apex) {
  const int begin = static_cast<int>(faces_.size());
  const int count = static_cast<int>(rim_.size());
  for (int k = 0; k < count; ++k) rim_face_[rim_[k].from] = begin + k;
  for (int k = 0; k < count; ++k) {
    const RimEdge& edge = rim_[k];
    push(edge.from, edge.to, apex, {edge.beyond, rim_face_[edge.to], -1});
    faces_[edge.beyond].neighbors[edge.slot] = begin + k;
  }
  for (int k = 0; k < count; ++k) faces_[rim_face_[rim_[k].to]].neighbors[2] = begin + k;
}

}  // namespace repel::detail
