// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds and reads the mesh files of a robot description.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/robots/robot.hpp>

namespace repel::detail {

/// Where mesh files are searched.
struct MeshFolders {
  std::filesystem::path file;              ///< the description itself
  std::vector<std::string> package_paths;  ///< see UrdfOptions
};

/// Whether this build has a reader for mesh files.
[[nodiscard]] bool has_mesh_reader() noexcept;

/// Resolves `uri`: package://NAME/PATH, model://NAME/PATH, file://PATH or a path relative to the
/// folder of the description.
/// @throws SetupError saying where it was searched
[[nodiscard]] std::filesystem::path find_mesh(const std::string& uri, const MeshFolders& folders);

/// The vertices of the convex hull of all triangles in a mesh file [m], scaled per axis. A unit
/// given in the file is applied, an up direction is ignored, as everywhere in ROS. The file is read
/// in a child process.
/// @throws SetupError also if the reader crashes or exceeds the memory or time of input_limits
[[nodiscard]] std::vector<Vec3> hull_of_mesh(const std::filesystem::path& path, const Vec3& scale);

/// read_mesh().
[[nodiscard]] TriangleMesh triangles_of_mesh(const std::filesystem::path& path, const Vec3& scale);

/// What a mesh becomes.
struct MeshParts {
  std::vector<std::vector<Vec3>> hulls;  ///< [m] corners of each
  bool is_cover = false;  ///< its convex parts; otherwise it has one hull, that of the mesh
  std::string path;       ///< of the file
};

/// Reads the meshes of one description, within the total limits of input_limits.
class MeshReader {
 public:
  MeshReader(MeshFolders folders, ConvexParts convex_parts)
      : folders_(std::move(folders)), convex_parts_(std::move(convex_parts)) {}

  /// The convex parts of the file behind `uri`, or hull_of_mesh() if it has none; each combination
  /// of file and scale is read once.
  /// @throws SetupError
  [[nodiscard]] const MeshParts& parts(const std::string& uri, const Vec3& scale);

 private:
  using Key = std::tuple<std::string, double, double, double>;  // path and scale

  [[nodiscard]] MeshParts read(const std::string& path, const Vec3& scale) const;

  MeshFolders folders_;
  ConvexParts convex_parts_;
  std::map<Key, MeshParts> meshes_;
  std::uintmax_t bytes_ = 0;
  std::size_t corners_ = 0;
};

}  // namespace repel::detail
