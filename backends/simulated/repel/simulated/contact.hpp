// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Physical contact in simulated arms: the shapes that can touch.
#pragma once

#include <span>
#include <string>

#include <repel/base/types.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/simulated/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// An obstacle, or a convex part of a simulated arm touching obstacles.
struct ContactPart {
  std::string name;              ///< for error messages
  int link = -1;                 ///< index in ArmModel::links; -1: an obstacle, fixed in the world
  Shape shape;                   ///< in its own frame
  Pose X_LP = Pose::Identity();  ///< [m] in its link; of an obstacle: in the world
};

/// Support values [m] of the core of `shape` along its x, y and z axis: half extents of a box; 0, 0
/// and half length of a capsule; radius, radius and half length of a cylinder or cone; the
/// semi-axes of an ellipsoid.
[[nodiscard]] Vec3 core_extents(const Shape& shape) noexcept;

/// Throws SetupError naming a part with a link not in `model` or a pose not rigid. Set-up only.
void require_touchable(std::span<const ContactPart> parts, const ArmModel& model);

}  // namespace repel
