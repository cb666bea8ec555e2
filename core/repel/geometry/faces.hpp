// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faces of a polytope, and which of them meet at a vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/vec.hpp>

namespace repel {

namespace detail {
class HullFaces;
}

/// Convex polygons, each the union of all facets in one plane. Empty for flat hulls: they have no
/// facets. Built by `hull_faces` (hull_faces.hpp).
class Faces {
 public:
  /// A corner of a face, at a vertex.
  struct Corner {
    std::uint32_t face;      ///< index of the face
    std::uint32_t next;      ///< the vertex after it, around the face
    std::uint32_t previous;  ///< and that before it
  };

  Faces() = default;

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
  /// The faces at a valid vertex; none when empty.
  [[nodiscard]] std::span<const Corner> at(std::uint32_t vertex) const noexcept {
    if (empty()) return {};
    return {at_.data() + first_at_[vertex], first_at_[vertex + 1] - first_at_[vertex]};
  }

  /// The unit vectors to a vertex from those after it, `Corner::next`, around the faces of `at`.
  [[nodiscard]] std::span<const Vec<double>> edges_to(std::uint32_t vertex) const noexcept {
    if (empty()) return {};
    return {edges_.data() + first_at_[vertex], first_at_[vertex + 1] - first_at_[vertex]};
  }

  /// [rad] Angle around its normal without other faces: a sixtieth of the angle to the nearest face
  /// at the same vertices, at most half of its own room. At most 1.
  [[nodiscard]] double room_of(std::uint32_t face) const noexcept { return face_room_[face]; }
  /// [rad] The same for the edges at a vertex: a quarter of the angle between the facing directions
  /// of two of them without a common face.
  [[nodiscard]] double room_at(std::uint32_t vertex) const noexcept { return vertex_room_[vertex]; }

 private:
  friend class detail::HullFaces;

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
