// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faces of a convex hull, from its facets. Set-up only: it allocates.
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
    faces_.normals_.shrink_to_fit();
    faces_.first_.shrink_to_fit();
    faces_.corners_.shrink_to_fit();
    index(vertices);
    find_room(vertices);
  }

  [[nodiscard]] Faces faces() && noexcept { return std::move(faces_); }

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
/// @param vertices the same points without those that are no vertices, in any order [m]
[[nodiscard]] inline Faces hull_faces(std::span<const Vec3> points,
                                      const std::vector<Facet>& facets,
                                      std::span<const Vec3> vertices) {
  return detail::HullFaces(points, facets, vertices).faces();
}

}  // namespace repel
