// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What kinematics and dynamics require of an ArmModel.
#pragma once

#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/world/arm.hpp>

namespace repel::detail {

inline void require_usable(const ArmLink& link) {
  const bool finite = is_finite(link.X_PJ) && is_finite(link.p_LC) && link.I_C_L.allFinite() &&
                      link.mass - link.mass == 0.0;
  if (!finite) throw SetupError("link '" + link.name + "' holds a value that is not finite");
  const std::string axis_length = "length of the axis of joint '" + link.joint_name + "'";
  checked(axis_length, link.axis_J.norm(), 1.0 - 1e-9, 1.0 + 1e-9, "");
}

/// @throws SetupError if the arm has no link, a value is not finite or an axis is not of unit
/// length
inline void require_usable(const ArmModel& arm) {
  if (arm.links.empty()) throw SetupError("arm '" + arm.name + "' has no link; allowed: 1 or more");
  if (!is_finite(arm.X_WB) || !is_finite(arm.X_LT) || !is_finite(arm.gravity_W)) {
    throw SetupError("arm '" + arm.name + "' has a base, tool or gravity that is not finite");
  }
  for (const ArmLink& link : arm.links) require_usable(link);
}

}  // namespace repel::detail
