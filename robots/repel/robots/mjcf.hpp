// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads arms, and what stands around them, from MJCF files, the format of MuJoCo.
#pragma once

#include <string>
#include <vector>

#include <repel/robots/built_alike.hpp>
#include <repel/robots/robot.hpp>

namespace repel {

/// Choices not in the file.
struct MjcfOptions {
  /// Body or site whose frame is the tool frame; the joints between the world and it are those of
  /// the arm. Empty: all joints must be in one line, and the last body that moves is the tool; or
  /// the line ends in fingers that are tied to one another, and the body that carries them is it.
  std::string tip{};
  /// Joints that are not to move. Those beside the arm are held without being named here.
  std::vector<Hold> hold{};
};

/// Reads the MJCF file at `path` by MuJoCo, in a child process. Joints beside the arm are held;
/// what fixed bodies carry is merged into their parents. A body with several joints becomes as many
/// links, of which the last has its mass. Collision geoms become parts, a mesh its convex hull;
/// geoms of the world itself are left out. Equality constraints, tendons and springs count where
/// they act on a joint of the arm.
/// @throws SetupError naming file, line where MuJoCo gives it, and element, if MuJoCo refuses the
///   file, it is no serial arm of hinges and slides, or something in it would be lost; always if
///   built without MuJoCo
[[nodiscard]] Robot load_mjcf_arm(const std::string& path, const MjcfOptions& options = {});

/// The collision geoms of all bodies in the MJCF file at `path`, those of the world included, as
/// parts of one body that stands still: their poses are in the world, with every joint at its
/// reference. It need not be an arm.
/// @throws SetupError as load_mjcf_arm(), but for what only an arm must have
[[nodiscard]] std::vector<RobotPart> load_mjcf_parts(const std::string& path);

/// Whether this build can read MJCF files.
[[nodiscard]] bool reads_mjcf() noexcept;

}  // namespace repel
