// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Triangle meshes from files: STL, OBJ, glTF, DAE and what else the reader knows.
#pragma once

#include <filesystem>

#include <repel/geometry/triangle_mesh.hpp>
#include <repel/robots/built_alike.hpp>

namespace repel {

/// Reads the triangles of a mesh file [m], scaled per axis: as in the file, but equal vertices
/// become one. A unit given in the file is applied, an up direction is ignored, as everywhere in
/// ROS. Polygons become triangles, points and lines are dropped. The file is read in a child
/// process.
/// @throws SetupError naming the file, also if the reader crashes or exceeds the memory or time of
///   input_limits, and where repel is built without a reader
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path,
                                     const Vec3& scale = Vec3::Ones());

}  // namespace repel
