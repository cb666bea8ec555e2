// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faces of a polytope, and which of them meet at a vertex.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/vec.hpp>
#include <repel/geometry/facets.hpp>

namespace repel {

/// Convex polygons, each the union of all facets in one plane. Empty for flat hulls, which have no
/// facets.
class Faces {
 public:
  /// A corner of a face, at a vertex.
  struct Corner {
    std::uint32_t face;      ///< index of the face
    std::uint32_t next;      ///< the vertex after it, around the face
    std::uint32_t previous;  ///< and that before it
  };

  Faces() = default;
  /// @param points the hull's, as `facets` refers to them
  /// @param vertices the same points without those that are no vertices, in any order [m]
  /// Set-up only: it allocates.
  Faces(std::span<const Vec3> points, const std::vector<Facet>& facets,
        std::span<const Vec3> vertices) {
    if (facets.empty()) return;
    using Triangle = std::array<std::uint32_t, 3>;
    std::map<std::array<double, 3>, std::uint32_t> names;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      names[{vertices[i].x(), vertices[i].y(), vertices[i].z()}] = static_cast<std::uint32_t>(i);
    }
    std::vector<Triangle> triangles;
    for (const Facet& facet : facets) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = points[facet.vertices[k]];
        triangle[k] = names.at({p.x(), p.y(), p.z()});
      }
      triangles.push_back(triangle);
    }
    add_joined(facets, triangles, vertices);
    normals_.shrink_to_fit();
    first_.shrink_to_fit();
    corners_.shrink_to_fit();
    index(vertices);
    find_room(vertices);
  }

  /// There are no faces: a set without thickness, or one that is not a polytope.
  [[nodiscard]] bool empty() const noexcept { return normals_.empty(); }
  /// [byte] Heap memory held, and the most for a hull of so many vertices.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return (normals_.capacity() + edges_.capacity()) * sizeof(Vec<double>) +
           (first_.capacity() + corners_.capacity() + first_at_.capacity()) *
               sizeof(std::uint32_t) +
           at_.capacity() * sizeof(Corner) +
           (face_room_.capacity() + vertex_room_.capacity()) * sizeof(float);
  }
  /// [bytes] Upper bound of the heap that the faces of so many vertices take.
  [[nodiscard]] static std::size_t most_bytes(std::size_t vertices) noexcept {
    // A closed surface of triangles has twice as many of them as vertices.
    return 8 * vertices * sizeof(Vec<double>) + (9 * vertices + 2) * sizeof(std::uint32_t) +
           6 * vertices * sizeof(Corner) + 3 * vertices * sizeof(float);
  }
  /// Number of faces.
  [[nodiscard]] std::size_t count() const noexcept { return normals_.size(); }
  /// The unit normal of face `i`, outward.
  [[nodiscard]] const Vec<double>& normal(std::uint32_t i) const noexcept { return normals_[i]; }
  /// The vertices of face `i`, in order around it.
  [[nodiscard]] std::span<const std::uint32_t> corners(std::uint32_t i) const noexcept {
    return {corners_.data() + first_[i], first_[i + 1] - first_[i]};
  }
  /// The faces that meet at a vertex, which must be valid; none when empty.
  [[nodiscard]] std::span<const Corner> at(std::uint32_t vertex) const noexcept {
    if (empty()) return {};
    return {at_.data() + first_at_[vertex], first_at_[vertex + 1] - first_at_[vertex]};
  }

  /// The unit vectors to a vertex from those after it, `Corner::next`, around the faces of `at`.
  [[nodiscard]] std::span<const Vec<double>> edges_to(std::uint32_t vertex) const noexcept {
    if (empty()) return {};
    return {edges_.data() + first_at_[vertex], first_at_[vertex + 1] - first_at_[vertex]};
  }

  /// [rad] How far around its normal a face is alone: a sixtieth of the angle to the nearest face
  /// that shares a vertex, and no more than half the room at its own. At most 1.
  [[nodiscard]] double room_of(std::uint32_t face) const noexcept { return face_room_[face]; }
  /// [rad] The same for the edges at a vertex: a quarter of the angle between the directions that
  /// two of them face, where they bound no common face.
  [[nodiscard]] double room_at(std::uint32_t vertex) const noexcept { return vertex_room_[vertex]; }

 private:
  /// [rad] Facets that share an edge and differ by less are one face.
  static constexpr double flat = 1e-7;

  /// Joins triangles across their common edges.
  template <class Triangles>
  void add_joined(const std::vector<Facet>& facets, const Triangles& triangles,
                  std::span<const Vec3> vertices) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> beside;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        beside[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
      }
    }
    std::vector<char> is_done(triangles.size());
    for (std::size_t start = 0; start < triangles.size(); ++start) {
      if (is_done[start] != 0) continue;
      std::vector<std::size_t> joined{start};
      std::vector<std::uint32_t> around;
      is_done[start] = 1;
      const Vec3& n = facets[start].n;
      for (std::size_t i = 0; i < joined.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t from = triangles[joined[i]][k];
          around.push_back(from);
          const auto other = beside.find({triangles[joined[i]][(k + 1) % 3], from});
          if (other == beside.end() || is_done[other->second] != 0) continue;
          if (norm(facets[other->second].n - n) > flat) continue;
          is_done[other->second] = 1;
          joined.push_back(other->second);
        }
      }
      add(n, std::move(around), vertices);
    }
    first_.push_back(static_cast<std::uint32_t>(corners_.size()));
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
    first_.push_back(static_cast<std::uint32_t>(corners_.size()));
    corners_.insert(corners_.end(), around.begin(), around.end());
    normals_.emplace_back(n);
  }

  /// Lists the faces at each vertex.
  void index(std::span<const Vec3> vertices) {
    first_at_.assign(vertices.size() + 1, 0);
    for (const std::uint32_t corner : corners_) ++first_at_[corner + 1];
    for (std::size_t i = 0; i < vertices.size(); ++i) first_at_[i + 1] += first_at_[i];
    at_.resize(corners_.size());
    edges_.resize(corners_.size());
    std::vector<std::uint32_t> next = first_at_;
    for (std::uint32_t face = 0; face < normals_.size(); ++face) {
      const auto around = corners(face);
      for (std::size_t k = 0; k < around.size(); ++k) {
        const std::uint32_t after = around[k + 1 < around.size() ? k + 1 : 0];
        const std::uint32_t place = next[around[k]]++;
        at_[place] = {face, after, around[k > 0 ? k - 1 : around.size() - 1]};
        edges_[place] = Vec<double>(normalized(Vec3(vertices[around[k]] - vertices[after])));
      }
    }
  }

  void find_room(std::span<const Vec3> vertices) {
    face_room_.assign(normals_.size(), 1.0F);
    vertex_room_.assign(vertices.size(), 1.0F);
    const auto lower = [](float& room, double to) {
      room = std::min(room, static_cast<float>(to));
    };
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
      for (const Corner& one : at(v)) {
        const Vec<double>& n = normals_[one.face];
        for (const Corner& other : at(v)) {
          if (other.face == one.face) continue;
          const Vec<double> between = normals_[other.face] - n;
          lower(face_room_[one.face], std::sqrt(dot(between, between)) / 60.0);
          if (at(v).size() == 3 || other.next == one.previous) continue;
          const Vec3 edge = vertices[other.next] - vertices[v];
          lower(vertex_room_[v], -0.25 * dot(n, Vec<double>(edge)) / edge.norm());
        }
      }
    }
    for (std::uint32_t face = 0; face < normals_.size(); ++face) {
      for (const std::uint32_t v : corners(face)) lower(face_room_[face], 0.5 * vertex_room_[v]);
    }
  }

  std::vector<Vec<double>> normals_;
  std::vector<std::uint32_t> first_;     ///< by face, where its corners begin
  std::vector<std::uint32_t> corners_;   ///< by face
  std::vector<std::uint32_t> first_at_;  ///< by vertex, where its faces begin
  std::vector<Corner> at_;               ///< by vertex
  std::vector<Vec<double>> edges_;       ///< by vertex, as `at_`
  std::vector<float> face_room_;         ///< [rad] by face
  std::vector<float> vertex_room_;       ///< [rad] by vertex
};

}  // namespace repel
