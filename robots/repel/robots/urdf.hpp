/// @file
/// Reads a robot from a URDF file: the arm as plain numbers, and the convex parts of its links.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>

namespace repel {

enum class PartKind { box, sphere, capsule, cylinder, hull };

/// One convex part of a link.
struct RobotPart {
  std::string name;  ///< of the collision element; of its link and number where it has none
  int link = -1;     ///< index in ArmModel::links; -1 for the base
  PartKind kind = PartKind::box;
  /// [m] box: half extents; sphere: radius, 0, 0; capsule and cylinder, along z: radius, half
  /// length (of a capsule without its caps), 0; hull: unused.
  Vec3 size = Vec3::Zero();
  std::vector<Vec3> points;      ///< [m] hull only, in the frame of the part
  Pose X_LP = Pose::Identity();  ///< [m] the part in its link
};

/// What a robot description holds.
struct Robot {
  ArmModel arm;
  std::vector<RobotPart> parts;
};

/// What the file itself does not decide.
struct UrdfOptions {
  std::string tip;  ///< link whose frame is the tool; empty: the end of the only chain
  std::vector<std::string> hold;  ///< moving joints to hold at zero, fingers for example
};

/// Reads the URDF file at `path`. Fixed and held joints are merged into their parents, with mass
/// and inertia. Throws SetupError, naming file, line, link or joint, value and what is allowed,
/// when the file cannot be read as a serial arm or anything in it would be lost.
[[nodiscard]] Robot load_arm(const std::string& path, const UrdfOptions& options = {});

/// The same for URDF text; `file` is the name that errors give.
[[nodiscard]] Robot parse_arm(std::string_view urdf, const UrdfOptions& options = {},
                              const std::string& file = "urdf");

}  // namespace repel
