/// @file
/// From an ArmModel to Bullet's articulated body.
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

/// Throws SetupError unless the Bullet library that was loaded computes in double precision.
void require_double_precision();

/// The articulated body of `model`, at zero, without Bullet's own damping.
[[nodiscard]] std::unique_ptr<btMultiBody> make_multibody(const ArmModel& model);

}  // namespace repel::bullet::detail
