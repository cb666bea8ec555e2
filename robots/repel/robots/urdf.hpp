/// @file
/// Reads a robot from a URDF file: the arm as plain numbers, and the convex parts of its links.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

enum class PartKind { box, sphere, capsule, cylinder, hull };

/// One convex part of a link.
struct RobotPart {
  std::string name;     ///< of the collision element; of its link and number where it has none
  std::string in_link;  ///< the link of the file that has it
  int link = -1;        ///< index in ArmModel::links; -1 for the base
  PartKind kind = PartKind::box;
  /// [m] box: half extents; sphere: radius, 0, 0; capsule and cylinder, along z: radius, half
  /// length (of a capsule without its caps), 0; hull: unused.
  Vec3 size = Vec3::Zero();
  /// [m] hull only, in the frame of the part: the corners of the convex hull of the file's mesh.
  std::vector<Vec3> points;
  Pose X_LP = Pose::Identity();  ///< [m] the part in its link
};

/// One link of the file. Those behind fixed or held joints move with a link of the arm.
struct RobotLink {
  std::string name;
  double mass = 0.0;             ///< [kg] of itself; 0 where the file gives none
  int link = -1;                 ///< index in ArmModel::links of what it moves with; -1: the base
  Pose X_LN = Pose::Identity();  ///< [m] its frame in that link
};

/// What a robot description holds.
struct Robot {
  ArmModel arm;
  std::vector<RobotLink> links;   ///< every link of the file, parents first
  std::vector<std::string> tips;  ///< moving links that carry no other, in the same order
  std::vector<RobotPart> parts;   ///< one for each collision element
};

/// What the file itself does not decide.
struct UrdfOptions {
  /// Link whose frame is the tool; empty: the only tip on the last moving link, or that link where
  /// it carries several.
  std::string tip{};
  std::vector<std::string> hold{};  ///< moving joints to hold at zero, fingers for example
  /// Folders in which package://NAME/ is looked for: each is the package, whatever it is called, or
  /// has it up to four folders deeper. The folders above the file are searched without being named.
  std::vector<std::string> package_paths{};
};

/// Reads the URDF file at `path`. Fixed and held joints are merged into their parents, with mass
/// and inertia; a collision mesh becomes the convex hull of its corners. Throws SetupError, naming
/// file, line, link or joint, value and what is allowed, when the file cannot be read as a serial
/// arm or anything in it would be lost.
[[nodiscard]] Robot load_arm(const std::string& path, const UrdfOptions& options = {});

/// The same for URDF text; `file` is the name that errors give, and its folder the one that paths
/// of meshes start from.
[[nodiscard]] Robot parse_arm(std::string_view urdf, const UrdfOptions& options = {},
                              const std::string& file = "urdf");

/// Two links of a robot that are never to be kept apart.
struct DisabledCollision {
  std::string first, second;  ///< links of the file
  std::string reason;         ///< what the file says: Adjacent, Never, ...
};

/// The <disable_collisions> of the SRDF file at `path`, in its order. Throws SetupError, naming
/// file and line, when it is not one or names a link that `robot` does not have.
[[nodiscard]] std::vector<DisabledCollision> load_disabled_collisions(const std::string& path,
                                                                      const Robot& robot);

/// Whether collision meshes can be read here; without it a file that has them is refused.
[[nodiscard]] bool reads_meshes() noexcept;

}  // namespace repel
