// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads what a robot looks like: the `<visual>` elements of its URDF file.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <repel/geometry/triangle_mesh.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/robots/robot.hpp>

namespace repel {

/// What a link looks like, or a part of it.
struct RobotVisual {
  std::string in_link;           ///< its link in the file
  int link = -1;                 ///< index in ArmModel::links of what it moves with; -1: the base
  Pose X_LV = Pose::Identity();  ///< [m] in that link
  std::optional<std::array<double, 4>> color{};  ///< red, green, blue, opacity, 0 to 1
  TriangleMesh mesh;                             ///< [m] in its own frame V
  std::string collision{};  ///< name of the RobotPart that it stands for; empty: a `<visual>`
};

/// What is only looked at is never refused.
struct RobotVisuals {
  std::vector<RobotVisual> all;       ///< in the order of Robot::links
  std::vector<std::string> warnings;  ///< with file and line: what is left out, or simplified
};

/// Most triangles of all visuals of a robot; beyond them each mesh is simplified by its share.
inline constexpr std::size_t most_visual_triangles = 50'000;

/// Reads the `<visual>` elements of the URDF file at `path`: box, sphere, cylinder, capsule, or a
/// mesh with its scale, and the colour of its material, its own or one of that name in the file. A
/// link without one, or without one that can be read, looks like its collision parts. May take
/// long: meshes are read in child processes.
/// @param robot from load_arm() of that file
/// @param options of which only `package_paths` counts
/// @throws SetupError if the file cannot be read as URDF
[[nodiscard]] RobotVisuals load_visuals(const std::string& path, const Robot& robot,
                                        const UrdfOptions& options = {});

/// The same for URDF text; `file` as for parse_arm().
[[nodiscard]] RobotVisuals parse_visuals(std::string_view urdf, const Robot& robot,
                                         const UrdfOptions& options = {},
                                         const std::string& file = "urdf");

}  // namespace repel
