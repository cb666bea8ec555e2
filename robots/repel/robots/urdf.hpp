/// @file
/// Reads a robot from a URDF file: its kinematic and dynamic parameters, and the convex parts of
/// its links.
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
  std::string name;     ///< of the collision element; if it has none, made from link and index
  std::string in_link;  ///< its link in the file
  int link = -1;        ///< index in ArmModel::links; -1 for the base
  PartKind kind = PartKind::box;
  /// [m] box: half extents; sphere: radius, 0, 0; capsule and cylinder, along z: radius, half
  /// length (of a capsule without its caps), 0; hull: unused.
  Vec3 size = Vec3::Zero();
  /// [m] hull only, in the frame of the part: the vertices of the convex hull of the mesh.
  std::vector<Vec3> points;
  Pose X_LP = Pose::Identity();  ///< [m] pose of the part in its link
};

/// One link of the file. A link behind a fixed or held joint moves with a link of the arm.
struct RobotLink {
  std::string name;
  double mass = 0.0;  ///< [kg] of this link alone; 0 if the file gives none
  int link = -1;      ///< index in ArmModel::links of the link it moves with; -1: the base
  Pose X_LN = Pose::Identity();  ///< [m] pose of its frame in that link
};

/// The content of a robot description.
struct Robot {
  ArmModel arm;
  std::vector<RobotLink> links;   ///< every link of the file, parents first
  std::vector<std::string> tips;  ///< moving links without children, in the same order
  std::vector<RobotPart> parts;   ///< one for each collision element
};

/// Choices that the file does not make.
struct UrdfOptions {
  /// Link whose frame is the tool frame. Empty: the only tip on the last moving link, or, if it has
  /// several, that link itself.
  std::string tip{};
  std::vector<std::string> hold{};  ///< movable joints to hold at zero, such as fingers
  /// Folders in which package://NAME/ is searched. Each is the package itself, under any name, or
  /// contains it up to four levels down. The folders above the file are always searched.
  std::vector<std::string> package_paths{};
};

/// Reads the URDF file at `path`. Fixed and held joints are merged into their parents, with mass
/// and inertia; a collision mesh becomes its convex hull.
/// @throws SetupError naming file, line, link or joint, value and what is allowed, if the file
///   cannot be read as a serial arm or anything in it would be lost
[[nodiscard]] Robot load_arm(const std::string& path, const UrdfOptions& options = {});

/// The same for URDF text; `file` is the name used in errors, and paths of meshes are relative to
/// its folder.
[[nodiscard]] Robot parse_arm(std::string_view urdf, const UrdfOptions& options = {},
                              const std::string& file = "urdf");

/// Two links of a robot between which collisions are ignored.
struct DisabledCollision {
  std::string first, second;  ///< links of the file
  std::string reason;         ///< given in the file: Adjacent, Never, ...
};

/// The <disable_collisions> of the SRDF file at `path`, in its order.
/// @throws SetupError naming file and line, if it is no SRDF file or names a link that `robot` does
///   not have
[[nodiscard]] std::vector<DisabledCollision> load_disabled_collisions(const std::string& path,
                                                                      const Robot& robot);

/// Whether this build can read collision meshes; otherwise a file that has some is refused.
[[nodiscard]] bool reads_meshes() noexcept;

}  // namespace repel
