// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads a robot from a URDF file: its kinematic and dynamic parameters, and the convex parts of
/// its links.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <repel/robots/built_alike.hpp>
#include <repel/robots/robot.hpp>

namespace repel {

/// Reads the URDF file at `path`. Joints beside the chain are held. What fixed and held joints
/// carry is merged into their parents, with mass and inertia; a collision mesh becomes its convex
/// parts if `options` find some, else its convex hull. A robot without a name has that of its file.
/// @throws SetupError naming file, line, link or joint, value and what is allowed, if the file
///   cannot be read as a serial arm or anything in it would be lost
[[nodiscard]] Robot load_arm(const std::string& path, const UrdfOptions& options = {});

/// The same for URDF text; `file` is the name used in errors, and paths of meshes are relative to
/// its folder.
[[nodiscard]] Robot parse_arm(std::string_view urdf, const UrdfOptions& options = {},
                              const std::string& file = "urdf");

/// The collision elements of the URDF file at `path` as parts of one body that stands still: their
/// poses are in the root link, with every joint at zero. It need not be an arm.
/// @param options of which only those about meshes count
/// @throws SetupError as load_arm(), but for what only an arm must have
[[nodiscard]] std::vector<RobotPart> load_parts(const std::string& path,
                                                const UrdfOptions& options = {});

/// Two links of a robot between which collisions are ignored.
struct DisabledCollision {
  std::string first;   ///< a link of the file
  std::string second;  ///< another one
  std::string reason;  ///< given in the file: Adjacent, Never, ...
};

/// The entries `disable_collisions` of the SRDF file at `path`, in its order.
/// @throws SetupError naming file and line, if it is no SRDF file or names a link that `robot` does
///   not have
[[nodiscard]] std::vector<DisabledCollision> load_disabled_collisions(const std::string& path,
                                                                      const Robot& robot);

/// Whether this build can read collision meshes; otherwise a file that has some is refused.
[[nodiscard]] bool reads_meshes() noexcept;

}  // namespace repel
