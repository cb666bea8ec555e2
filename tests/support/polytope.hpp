// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The features of a small polytope: its faces and edges, found by testing all triples of vertices
/// with an orientation test decided in 113 bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <support/quad.hpp>

namespace repel::oracle {

/// One face with its corners in order, or one side of a flat polytope.
struct Face {
  std::vector<int> corners;  ///< counter-clockwise seen from outside
  Vec3 n = Vec3::Zero();     ///< unit, outward
  double offset = 0.0;       ///< [m] n.x of its corners
};

/// The convex hull of up to `most` vertices with all its features; of more vertices, only the
/// vertices. A flat hull has a face on either side; a segment has one edge; a point has neither.
class Polytope {
 public:
  static constexpr std::size_t most = 32;  ///< the cost grows too fast beyond

  /// Repeated vertices count once.
  explicit Polytope(std::span<const Vec3> vertices) {
    for (const Vec3& v : vertices) {
      reach_ = std::max(reach_, v.norm());
      if (std::find(vertices_.begin(), vertices_.end(), v) == vertices_.end()) {
        vertices_.push_back(v);
      }
    }
    if (vertices_.size() > most) return;
    find_faces();
    if (faces_.empty()) find_segment();
    find_directions();
  }

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const std::vector<std::array<int, 2>>& edges() const { return edges_; }
  /// One edge of each set of parallel edges.
  [[nodiscard]] const std::vector<std::array<int, 2>>& directions() const { return directions_; }
  [[nodiscard]] double reach() const { return reach_; }  ///< [m] farthest vertex from the origin

  /// True if the faces bound a solid: every edge is shared by two of them, and Euler's formula
  /// holds. Then no face and no edge is missing.
  [[nodiscard]] bool closed() const {
    std::uint32_t used = 0;
    std::size_t sides = 0;
    for (const Face& f : faces_) {
      sides += f.corners.size();
      for (const int corner : f.corners) used |= 1U << corner;
    }
    const int corners = __builtin_popcount(used);
    return sides == 2 * edges_.size() &&
           corners + static_cast<int>(faces_.size()) == static_cast<int>(edges_.size()) + 2;
  }

  /// [m] Distance of `x`, in the frame of the polytope, outside the worst face plane; negative
  /// inside. Undefined without faces.
  [[nodiscard]] double outside_by(const Vec3& x) const {
    double worst = -1e300;
    for (const Face& f : faces_) worst = std::max(worst, f.n.dot(x) - f.offset);
    return worst;
  }

 private:
  [[nodiscard]] int count() const { return static_cast<int>(vertices_.size()); }

  /// The sign of `value`, whose rounding error is bounded by `scale`; recomputed if in doubt.
  static int sign(double value, double scale, auto&& exactly) {
    if (std::abs(value) > 1e-14 * scale) return value > 0.0 ? 1 : -1;
    const Real precise = exactly();
    if (magnitude(precise) <= Real(1e-30) * Real(scale)) return 0;
    return precise > 0 ? 1 : -1;
  }

  /// The side of the plane of i, j, k on which vertex l lies.
  [[nodiscard]] int side(int i, int j, int k, int l) const {
    const Vec3 e = vertices_[j] - vertices_[i];
    const Vec3 f = vertices_[k] - vertices_[i];
    const Vec3 g = vertices_[l] - vertices_[i];
    return sign(e.cross(f).dot(g), e.norm() * f.norm() * g.norm(), [&] {
      const Point p = exact(vertices_[i]);
      return dot(cross(exact(vertices_[j]) - p, exact(vertices_[k]) - p), exact(vertices_[l]) - p);
    });
  }

  [[nodiscard]] bool parallel(const std::array<int, 2>& a, const std::array<int, 2>& b) const {
    const Vec3 e = vertices_[a[1]] - vertices_[a[0]];
    const Vec3 f = vertices_[b[1]] - vertices_[b[0]];
    return sign(e.cross(f).norm(), e.norm() * f.norm(), [&] {
             const Point n = cross(exact(vertices_[a[1]]) - exact(vertices_[a[0]]),
                                   exact(vertices_[b[1]]) - exact(vertices_[b[0]]));
             return square_root(dot(n, n));
           }) == 0;
  }

  void find_faces() {
    std::vector<std::uint32_t> known;
    for (int i = 0; i < count(); ++i) {
      for (int j = i + 1; j < count(); ++j) {
        for (int k = j + 1; k < count(); ++k) {
          const std::uint32_t triple = 1U << i | 1U << j | 1U << k;
          const auto holds = [&](std::uint32_t face) { return (face & triple) == triple; };
          if (std::any_of(known.begin(), known.end(), holds)) continue;
          if (parallel({i, j}, {i, k})) continue;
          try_plane(i, j, k, known);
        }
      }
    }
  }

  void try_plane(int i, int j, int k, std::vector<std::uint32_t>& known) {
    bool above = false;
    bool below = false;
    std::uint32_t in_plane = 0;
    for (int l = 0; l < count() && !(above && below); ++l) {
      const int s = l == i || l == j || l == k ? 0 : side(i, j, k, l);
      above = above || s > 0;
      below = below || s < 0;
      in_plane |= s == 0 ? 1U << l : 0U;
    }
    if (above && below) return;
    known.push_back(in_plane);
    const Vec3 n = (vertices_[j] - vertices_[i]).cross(vertices_[k] - vertices_[i]).normalized();
    if (!above) add_face(in_plane, n);
    if (!below) add_face(in_plane, -n);
  }

  /// Gift wrapping of the corners of the plane: the next corner has no other to its right, and is
  /// the farthest of several on one line.
  void add_face(std::uint32_t in_plane, const Vec3& n) {
    Face face{{}, n, -1e300};
    int corner = -1;
    for (int l = 0; l < count(); ++l) {
      if ((in_plane >> l & 1U) == 0) continue;
      face.offset = std::max(face.offset, n.dot(vertices_[l]));
      // The point farthest from any given point is a corner.
      if (corner < 0 || farther(l, corner)) corner = l;
    }
    while (std::find(face.corners.begin(), face.corners.end(), corner) == face.corners.end() &&
           face.corners.size() < most) {
      face.corners.push_back(corner);
      corner = next_corner(in_plane, n, corner);
      add_edge(face.corners.back(), corner);
    }
    faces_.push_back(face);
  }

  [[nodiscard]] bool farther(int l, int than) const {
    return vertices_[l].squaredNorm() > vertices_[than].squaredNorm();
  }

  [[nodiscard]] int next_corner(std::uint32_t in_plane, const Vec3& n, int from) const {
    int next = -1;
    for (int l = 0; l < count(); ++l) {
      const Vec3 e = vertices_[l] - vertices_[from];
      if ((in_plane >> l & 1U) == 0 || e.isZero(0.0)) continue;
      if (next < 0) {
        next = l;
        continue;
      }
      const Vec3 f = vertices_[next] - vertices_[from];
      const bool same = parallel({from, l}, {from, next});
      if (same ? e.squaredNorm() > f.squaredNorm() : f.cross(e).dot(n) < 0.0) next = l;
    }
    return next;
  }

  void add_edge(int from, int to) {
    const std::array<int, 2> edge{std::min(from, to), std::max(from, to)};
    if (std::find(edges_.begin(), edges_.end(), edge) == edges_.end()) edges_.push_back(edge);
  }

  /// Collinear vertices: the first and the last.
  void find_segment() {
    std::array<int, 2> ends{0, 0};
    double longest = 0.0;
    for (int i = 0; i < count(); ++i) {
      for (int j = i + 1; j < count(); ++j) {
        const double length = (vertices_[j] - vertices_[i]).norm();
        if (length <= longest) continue;
        longest = length;
        ends = {i, j};
      }
    }
    if (longest > 0.0) edges_.push_back(ends);
  }

  void find_directions() {
    for (const auto& e : edges_) {
      const auto same = [&](const auto& d) { return parallel(d, e); };
      if (std::none_of(directions_.begin(), directions_.end(), same)) directions_.push_back(e);
    }
  }

  std::vector<Vec3> vertices_;  ///< [m]
  std::vector<Face> faces_;
  std::vector<std::array<int, 2>> edges_;
  std::vector<std::array<int, 2>> directions_;
  double reach_ = 0.0;
};

}  // namespace repel::oracle
