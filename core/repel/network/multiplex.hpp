/// @file
/// MULTIPLEX: couples a device of one degree of freedom to the six of the tool.
#pragma once

#include <repel/base/spatial.hpp>

namespace repel::network {

/// A transformer along one unit direction d: v6 = s_v d v1 and f1 = s_f d.f6. With s_f = s_v it
/// passes all power on; otherwise the power factor s_f / s_v is what it declares.
struct Multiplex {
  Vec3 direction_W = Vec3::UnitX();  ///< unit, world axes
  double velocity_scale = 1.0;       ///< s_v [m/rad]
  double force_scale = 1.0;          ///< s_f [m]

  /// Twist of the tool [m/s] for a lever rate [rad/s].
  [[nodiscard]] Twist flow(double rate) const noexcept {
    return {velocity_scale * rate * direction_W, Vec3::Zero()};
  }
  /// Torque on the lever [N m] for a force on the tool [N].
  [[nodiscard]] double effort(const Vec3& force_W) const noexcept {
    return force_scale * direction_W.dot(force_W);
  }
};

}  // namespace repel::network
