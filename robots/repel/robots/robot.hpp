// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A robot description as plain numbers and convex parts.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The form of a part.
enum class PartKind { box, sphere, capsule, cylinder, ellipsoid, hull };

/// The name of `kind`.
[[nodiscard]] constexpr const char* to_text(PartKind kind) noexcept {
  switch (kind) {
    case PartKind::box:
      return "box";
    case PartKind::sphere:
      return "sphere";
    case PartKind::capsule:
      return "capsule";
    case PartKind::cylinder:
      return "cylinder";
    case PartKind::ellipsoid:
      return "ellipsoid";
    case PartKind::hull:
      break;
  }
  return "hull";
}

/// One convex part of a link.
struct RobotPart {
  std::string name;     ///< of the collision element; if it has none, made from link and index
  std::string in_link;  ///< its link in the file
  int link = -1;        ///< index in ArmModel::links; -1 for the base
  PartKind kind = PartKind::box;  ///< its form
  /// [m] box: half extents; ellipsoid: semi-axes; sphere: radius, 0, 0; capsule and cylinder, along
  /// z: radius, half length (of a capsule without its caps), 0; hull: unused.
  Vec3 size = Vec3::Zero();
  /// [m] hull only, in the frame of the part: the vertices of the convex hull of the mesh, or of
  /// one of its convex parts.
  std::vector<Vec3> points;
  bool is_of_cover =
      false;         ///< a hull from UrdfOptions::convex_parts; its name ends in /1, /2, ...
  std::string mesh;  ///< path of the mesh file; hull only
  Vec3 mesh_scale = Vec3::Ones();  ///< factors of its vertices; hull only
  Pose X_LP = Pose::Identity();    ///< [m] pose of the part in its link
};

/// One link of the file. A link behind a fixed or held joint moves with a link of the arm.
struct RobotLink {
  std::string name;   ///< as in the file
  double mass = 0.0;  ///< [kg] of this link alone; 0 if the file gives none
  int link = -1;      ///< index in ArmModel::links of the link it moves with; -1: the base
  Pose X_LN = Pose::Identity();  ///< [m] pose of its frame in that link
};

/// A movable joint held still: beside the arm, or chosen to be held.
struct HeldJoint {
  std::string name;       ///< as in the file
  std::string type;       ///< revolute, continuous, prismatic, planar or floating
  double position = 0.0;  ///< where: [rad], or [m] if prismatic
  std::string reason;     ///< why it is held, and why there
};

/// The content of a robot description.
struct Robot {
  ArmModel arm;                   ///< what controls and simulates it
  std::vector<RobotLink> links;   ///< every link of the file, parents first
  std::vector<std::string> tips;  ///< moving links without children, in the same order
  std::vector<RobotPart> parts;   ///< one or more for each collision element
  std::vector<HeldJoint> held;    ///< parents first
  std::string end;                ///< the last link of the chosen chain
  std::string end_reason;         ///< why that chain
  std::string tool;               ///< the link whose frame is the tool frame
  std::string tool_reason;        ///< why that link
};

/// A joint to hold still.
struct Hold {
  /// The joint of that name, where the file puts it.
  Hold(const char* name) : joint(name) {}
  /// The joint of that name, where the file puts it.
  Hold(std::string name) : joint(std::move(name)) {}
  /// The joint of that name at `at`, in the unit of its type [rad], [m].
  Hold(std::string name, double at) : joint(std::move(name)), position(at) {}
  /// The same, of type `kind`.
  Hold(std::string name, double at, JointType kind)
      : joint(std::move(name)), position(at), type(kind) {}

  std::string joint;  ///< its name in the file
  /// [rad] or [m] where. Without: by the mimicked joint if that is held too, else at zero, or at
  /// its limit nearest to zero.
  std::optional<double> position;
  std::optional<JointType> type;  ///< which of the two units it is; without, that of the joint
};

/// Finds the convex parts of the mesh file at `path`, with each vertex multiplied by `scale`: the
/// corners of each [m]. None: the mesh becomes its convex hull.
using ConvexParts =
    std::function<std::vector<std::vector<Vec3>>(const std::string& path, const Vec3& scale)>;

/// Choices not in the file.
struct UrdfOptions {
  /// Link whose frame is the tool frame; the joints between the root and this link are those of the
  /// arm. Empty: the longest chain without its gripper, by the rules of docs/robots.md.
  std::string tip{};
  /// Joints that are not to move. Those beside the chain are held without being named here.
  std::vector<Hold> hold{};
  /// Folders in which package://NAME/ is searched. Each is the package itself, under any name, or
  /// contains it up to four levels down. The folders above the file are always searched.
  std::vector<std::string> package_paths{};
  /// Where collision meshes have their convex parts from; without, each becomes its convex hull.
  /// What it throws is reported with the line of the mesh.
  ConvexParts convex_parts{};
};

}  // namespace repel
