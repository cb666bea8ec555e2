/// @file
/// Finds and reads the mesh files that a robot description names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::detail {

/// Where files are looked for.
struct MeshFolders {
  std::filesystem::path file;              ///< the description itself
  std::vector<std::string> package_paths;  ///< see UrdfOptions
};

/// The file behind `uri`: package://NAME/PATH, model://NAME/PATH, file://PATH or a path from the
/// folder of the description. Throws SetupError that says where it was looked for.
[[nodiscard]] std::filesystem::path find_mesh(const std::string& uri, const MeshFolders& folders);

/// The corners of the convex hull of all triangles in a mesh file [m], scaled axis by axis. A unit
/// the file states is heeded, an up direction is not, as everywhere in ROS. Throws SetupError.
[[nodiscard]] std::vector<Vec3> hull_of_mesh(const std::filesystem::path& path, const Vec3& scale);

}  // namespace repel::detail
