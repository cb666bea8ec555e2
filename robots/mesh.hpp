/// @file
/// Finds and reads the mesh files that a robot description names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
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
/// the file states is heeded, an up direction is not, as everywhere in ROS. The file is read in a
/// process of its own: what crashes the reader, or takes more memory or time than input_limits
/// allows, is refused. Throws SetupError.
[[nodiscard]] std::vector<Vec3> hull_of_mesh(const std::filesystem::path& path, const Vec3& scale);

/// Reads the meshes of one description, all of them together within input_limits.
class MeshReader {
 public:
  explicit MeshReader(MeshFolders folders) : folders_(std::move(folders)) {}

  /// hull_of_mesh() of the file behind `uri`; of the same file at the same scale it is read once.
  /// Throws SetupError.
  [[nodiscard]] const std::vector<Vec3>& hull(const std::string& uri, const Vec3& scale);

 private:
  using Key = std::tuple<std::string, double, double, double>;  // path and scale

  MeshFolders folders_;
  std::map<Key, std::vector<Vec3>> hulls_;
  std::uintmax_t bytes_ = 0;
  std::size_t corners_ = 0;
};

}  // namespace repel::detail
