// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Converts an ArmModel to Bullet's articulated body.
#pragma once

#include <memory>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <repel/world/arm.hpp>

namespace repel::bullet::detail {

/// `v` in Bullet's type, same frame and unit.
[[nodiscard]] inline btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// `X` in Bullet's type.
[[nodiscard]] btTransform to_bullet(const Pose& X);

/// @throws SetupError unless the loaded Bullet library was built in double precision
void require_double_precision();

/// The articulated body of `model`, with all joints at zero and without Bullet's own damping.
[[nodiscard]] std::unique_ptr<btMultiBody> make_multibody(const ArmModel& model);

}  // namespace repel::bullet::detail
