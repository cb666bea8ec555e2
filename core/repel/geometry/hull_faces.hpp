// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faces of a convex hull, from its facets. Set-up only: it allocates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <repel/base/vec.hpp>
#include <repel/geometry/faces.hpp>
#include <repel/geometry/facets.hpp>

namespace repel {

namespace detail {

/// Joins facets to faces.
class HullFaces {
 public:
  HullFaces(std::span<const Vec3> points, const std::vector<Facet>& facets,
            std::span<const Vec3> vertices) {
    if (facets.empty()) return;
    add_joined(facets, triangles_of(points, facets, vertices), vertices);
    // Copies hold no more memory than they need.
    faces_.normals_ = std::vector<Vec<double>>(faces_.normals_);
    faces_.first_ = std::vector<std::uint32_t>(faces_.first_);
    faces_.corners_ = std::vector<std::uint32_t>(faces_.corners_);
    index(vertices);
    find_room(vertices);
  }

  [[nodiscard]] Faces faces() && noexcept { return std::move(faces_); }

 private:
  /// [rad] Facets sharing an edge with a smaller angle are one face.
  static constexpr double flat = 1e-7;

  /// The indices of the vertices of all facets; of several at one place, that of the last.
  static std::vector<std::uint32_t> triangles_of(std::span<const Vec3> points,
                                                 const std::vector<Facet>& facets,
                                                 std::span<const Vec3> vertices) {
    const auto is_before = [](const Vec3& p, const Vec3& q) {
      if (p[0] != q[0]) return p[0] < q[0];
      return p[1] != q[1] ? p[1] < q[1] : p[2] < q[2];
    };
    std::vector<std::uint32_t> in_order(vertices.size());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) in_order[i] = i;
    std::sort(in_order.begin(), in_order.end(), [&](std::uint32_t i, std::uint32_t k) {
      return is_same(vertices[i], vertices[k]) ? i > k : is_before(vertices[i], vertices[k]);
    });
    std::vector<std::uint32_t> triangles;
    triangles.reserve(3 * facets.size());
    for (const Facet& facet : facets) {
      for (const int i : facet.vertices) {
        const Vec3& p = points[i];
        const auto place =
            std::partition_point(in_order.begin(), in_order.end(),
                                 [&](std::uint32_t k) { return is_before(vertices[k], p); });
        if (place == in_order.end() || !is_same(vertices[*place], p)) {
          throw std::out_of_range("a facet has a vertex that is not among those of the hull");
        }
        triangles.push_back(*place);
      }
    }
    return triangles;
  }

  /// The corners of triangles, by vertex. Triangle t has the vertices 3 t to 3 t + 2 of those
  /// given.
  class Corners {
   public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    Corners(const std::vector<std::uint32_t>& triangles, std::size_t vertices)
        : first_(vertices + 1), corners_(triangles.size()) {
      for (const std::uint32_t vertex : triangles) ++first_[vertex + 1];
      for (std::size_t i = 0; i < vertices; ++i) first_[i + 1] += first_[i];
      std::vector<std::uint32_t> next = first_;
      for (std::uint32_t t = 0; std::size_t{3} * t < triangles.size(); ++t) {
        const std::uint32_t* const triangle = &triangles[std::size_t{3} * t];
        for (std::size_t k = 0; k < 3; ++k) {
          corners_[next[triangle[k]]++] = {t, triangle[(k + 1) % 3], triangle[(k + 2) % 3]};
        }
      }
    }

    /// The last triangle with the edge from one vertex to another, or none. Searches at the end
    /// with fewer triangles, so all edges of a hull take a time linear in its vertices.
    [[nodiscard]] std::uint32_t beside(std::uint32_t from, std::uint32_t to) const {
      const bool is_at_from = first_[from + 1] - first_[from] <= first_[to + 1] - first_[to];
      const std::uint32_t vertex = is_at_from ? from : to;
      for (std::uint32_t i = first_[vertex + 1]; i-- > first_[vertex];) {
        if (is_at_from ? corners_[i].next == to : corners_[i].previous == from) {
          return corners_[i].face;
        }
      }
      return none;
    }

   private:
    std::vector<std::uint32_t> first_;  ///< of the corners at each vertex
    std::vector<Faces::Corner> corners_;
  };

  /// Joins triangles across their common edges.
  void add_joined(const std::vector<Facet>& facets, const std::vector<std::uint32_t>& triangles,
                  std::span<const Vec3> vertices) {
    const Corners corners(triangles, vertices.size());
    std::vector<char> is_done(facets.size());
    for (std::size_t start = 0; start < facets.size(); ++start) {
      if (is_done[start] != 0) continue;
      std::vector<std::size_t> joined{start};
      std::vector<std::uint32_t> around;
      is_done[start] = 1;
      const Vec3& n = facets[start].n;
      for (std::size_t i = 0; i < joined.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t from = triangles[3 * joined[i] + k];
          around.push_back(from);
          const std::uint32_t other = corners.beside(triangles[3 * joined[i] + (k + 1) % 3], from);
          if (other == Corners::none || is_done[other] != 0) continue;
          if (norm(facets[other].n - n) > flat) continue;
          is_done[other] = 1;
          joined.push_back(other);
        }
      }
      add(n, std::move(around), vertices);
    }
    faces_.first_.push_back(static_cast<std::uint32_t>(faces_.corners_.size()));
  }

  /// Adds a face with these vertices, in any order and repeated.
  void add(const Vec3& n, std::vector<std::uint32_t> around, std::span<const Vec3> vertices) {
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    Vec3 middle(0, 0, 0);
    for (const std::uint32_t i : around) {
      middle += vertices[i] / static_cast<double>(around.size());
    }
    const Vec3 u = vertices[around[0]] - middle;
    const Vec3 v = n.cross(u);
    const auto angle = [&](std::uint32_t i) {
      const Vec3 r = vertices[i] - middle;
      return std::atan2(dot(r, v), dot(r, u));
    };
    std::sort(around.begin(), around.end(),
              [&](std::uint32_t i, std::uint32_t k) { return angle(i) < angle(k); });
    faces_.first_.push_back(static_cast<std::uint32_t>(faces_.corners_.size()));
    faces_.corners_.insert(faces_.corners_.end(), around.begin(), around.end());
    faces_.normals_.emplace_back(n);
  }

  /// Lists the faces at each vertex.
  void index(std::span<const Vec3> vertices) {
    faces_.first_at_.assign(vertices.size() + 1, 0);
    for (const std::uint32_t corner : faces_.corners_) ++faces_.first_at_[corner + 1];
    for (std::size_t i = 0; i < vertices.size(); ++i)
      faces_.first_at_[i + 1] += faces_.first_at_[i];
    faces_.at_.resize(faces_.corners_.size());
    faces_.edges_.resize(faces_.corners_.size());
    std::vector<std::uint32_t> next = faces_.first_at_;
    for (std::uint32_t face = 0; face < faces_.normals_.size(); ++face) {
      const auto around = faces_.corners(face);
      for (std::size_t k = 0; k < around.size(); ++k) {
        const std::uint32_t after = around[k + 1 < around.size() ? k + 1 : 0];
        const std::uint32_t place = next[around[k]]++;
        faces_.at_[place] = {face, after, around[k > 0 ? k - 1 : around.size() - 1]};
        faces_.edges_[place] = Vec<double>(normalized(Vec3(vertices[around[k]] - vertices[after])));
      }
    }
  }

  void find_room(std::span<const Vec3> vertices) {
    faces_.face_room_.assign(faces_.normals_.size(), 1.0F);
    faces_.vertex_room_.assign(vertices.size(), 1.0F);
    const auto lower = [](float& room, double to) {
      room = std::min(room, static_cast<float>(to));
    };
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
      for (const Faces::Corner& one : faces_.at(v)) {
        const Vec<double>& n = faces_.normals_[one.face];
        for (const Faces::Corner& other : faces_.at(v)) {
          if (other.face == one.face) continue;
          const Vec<double> between = faces_.normals_[other.face] - n;
          lower(faces_.face_room_[one.face], std::sqrt(dot(between, between)) / 60.0);
          if (faces_.at(v).size() == 3 || other.next == one.previous) continue;
          const Vec3 edge = vertices[other.next] - vertices[v];
          lower(faces_.vertex_room_[v], -0.25 * dot(n, Vec<double>(edge)) / norm(edge));
        }
      }
    }
    for (std::uint32_t face = 0; face < faces_.normals_.size(); ++face) {
      for (const std::uint32_t v : faces_.corners(face))
        lower(faces_.face_room_[face], 0.5 * faces_.vertex_room_[v]);
    }
  }

  Faces faces_;
};

}  // namespace detail

/// The faces of a hull.
/// @param points as `facets` refers to them
/// @param vertices the vertices among these points, in any order [m]
[[nodiscard]] inline Faces hull_faces(std::span<const Vec3> points,
                                      const std::vector<Facet>& facets,
                                      std::span<const Vec3> vertices) {
  return detail::HullFaces(points, facets, vertices).faces();
}

}  // namespace repel
