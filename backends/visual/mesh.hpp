/// @file
/// Triangles to show a level of a shape with.
#pragma once

#include <array>
#include <vector>

#include <repel/reduction/shape.hpp>

namespace repel::visual {

/// A closed convex surface; for a set without thickness its points, and triangles if it is flat.
struct Mesh {
  std::vector<Vec3> vertices;                 ///< [m] in the frame of the shape
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// What is left of a shape at one level of its reduction: for level 0 the shape itself, for others
/// the set that is eroded by their depth. Polytopes exactly, curved sets by chords: rims of the
/// first level have 48 corners, those of the others 24.
[[nodiscard]] Mesh mesh_of(const Shape& shape, int level);

}  // namespace repel::visual
