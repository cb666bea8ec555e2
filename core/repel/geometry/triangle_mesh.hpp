// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Triangle meshes: surfaces that need not be convex. Set-up only: they allocate.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <repel/base/types.hpp>

namespace repel {

/// A surface of triangles. Nothing is required of it: it may be open, or pass through itself.
struct TriangleMesh {
  std::vector<Vec3> vertices;                 ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices; as a rule, the outside sees
                                              ///< them counter-clockwise

  /// The corners of a triangle [m]. Its indices must be those of vertices.
  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices[a], vertices[b], vertices[c]};
  }
};

}  // namespace repel
