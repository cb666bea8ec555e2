// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bodies with a prescribed motion: a box on a conveyor, a sliding door.
#pragma once

#include <repel/world/world.hpp>

namespace repel {

/// Sinusoidal motion to and fro on a line: at rest at both ends, at the far end after half the
/// duration.
struct ReciprocatingMotion {
  Vec3 along_W{0, 0, 0};  ///< [m] from where the body starts to the far end
  double duration = 1.0;  ///< [s] there and back, above 0

  /// [m] Displacement `time` [s] after the start.
  [[nodiscard]] Vec3 offset(double time) const noexcept;
  /// Greatest speed [m/s].
  [[nodiscard]] double top_speed() const noexcept;
};

/// A body with a prescribed motion, whatever forces act on it.
struct MovingBody {
  BodyId body;                   ///< that moves
  Pose X_WB = Pose::Identity();  ///< [m] where it starts
  ReciprocatingMotion motion;    ///< of its frame

  /// Places the body at its pose `time` [s] after the start. False for an invalid pose: the body is
  /// not moved.
  [[nodiscard]] bool place(World& world, double time) const noexcept;
};

}  // namespace repel
