// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms of a cell from robot descriptions. The program that includes it links repel::control.
#pragma once

#include <memory>
#include <string>

#include <repel/cell/description.hpp>
#include <repel/robots/mjcf.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/world/kinematics.hpp>

namespace repel {

/// The model, the kinematics and the parts of `robot`; what is fixed to its base is left out. The
/// rest is by default.
/// @throws SetupError if the sizes of a part are out of range
[[nodiscard]] inline ArmDescription arm_of(const Robot& robot) {
  ArmDescription arm;
  arm.model = robot.arm;
  arm.kinematics = std::make_unique<Kinematics>(robot.arm);
  for (const RobotPart& part : robot.parts) {
    if (part.link < 0) continue;
    arm.parts.push_back({part.name, shape_of(part, {.levels = 1}), part.X_LP, part.link});
  }
  return arm;
}

/// arm_of() the URDF file at `path`.
/// @throws SetupError as load_arm() and arm_of()
[[nodiscard]] inline ArmDescription arm_from_urdf(const std::string& path,
                                                  const UrdfOptions& options = {}) {
  return arm_of(load_arm(path, options));
}

/// arm_of() the MJCF file at `path`.
/// @throws SetupError as load_mjcf_arm() and arm_of()
[[nodiscard]] inline ArmDescription arm_from_mjcf(const std::string& path,
                                                  const MjcfOptions& options = {}) {
  return arm_of(load_mjcf_arm(path, options));
}

}  // namespace repel
