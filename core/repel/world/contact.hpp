// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Physical contact in simulated arms: which shapes can touch.
#pragma once

#include <span>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// A convex part of a simulated arm that can touch obstacles, or an obstacle.
struct ContactPart {
  std::string name;              ///< for error messages
  int link = -1;                 ///< index in ArmModel::links; -1: an obstacle, fixed in the world
  Shape shape;                   ///< in its own frame
  Pose X_LP = Pose::Identity();  ///< [m] in its link; of an obstacle: in the world
};

/// Support values [m] of the core of `shape` along its x, y and z axis: half extents of a box; 0, 0
/// and half length of a capsule; radius, radius and half length of a cylinder or cone.
[[nodiscard]] inline Vec3 core_extents(const Shape& shape) noexcept {
  const Convex& core = shape.level(0).core;
  return {core.support_value({1.0, 0.0, 0.0}), core.support_value({0.0, 1.0, 0.0}),
          core.support_value({0.0, 0.0, 1.0})};
}

/// Throws SetupError naming the part whose link is not in `model` or whose pose is not rigid.
/// Set-up only.
inline void require_touchable(std::span<const ContactPart> parts, const ArmModel& model) {
  const int links = static_cast<int>(model.links.size());
  for (const ContactPart& part : parts) {
    const std::string whose = "part '" + part.name + "': ";
    if (part.link < -1 || part.link >= links) {
      throw SetupError(whose + "link is " + std::to_string(part.link) + "; allowed: -1 to " +
                       std::to_string(links - 1));
    }
    if (!is_finite(part.X_LP) || !is_rigid(part.X_LP)) {
      throw SetupError(whose + "X_LP is not a rigid pose");
    }
  }
}

}  // namespace repel
