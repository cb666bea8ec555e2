/// @file
/// Triangle meshes of the reduction levels of a shape, for display.
#pragma once

#include <array>
#include <vector>

#include <repel/reduction/shape.hpp>

namespace repel::visual {

/// A closed convex surface; for a set without volume its points, and triangles if it is planar.
struct Mesh {
  std::vector<Vec3> vertices;                 ///< [m] in the frame of the shape
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// The mesh of one reduction level: for level 0 the shape itself, for others the set eroded by
/// their depth. Polytopes exactly, curved sets by chords: 48 corners per rim on the first level, 24
/// on the others.
[[nodiscard]] Mesh mesh_of(const Shape& shape, int level);

}  // namespace repel::visual
