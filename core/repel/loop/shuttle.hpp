/// @file
/// Bodies that move by themselves: a box on a conveyor, a sliding door.
#pragma once

#include <cmath>
#include <numbers>

#include <repel/base/spatial.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// A body that goes to and fro along a line, whatever pushes it: gently away, there at half the
/// time, and back.
struct Shuttle {
  BodyId body;
  Pose X_WB = Pose::Identity();  ///< [m] where it starts
  Vec3 along_W{0, 0, 0};         ///< [m] from there to the far end
  double duration = 1.0;         ///< [s] there and back, above 0

  /// The most it moves [m/s].
  [[nodiscard]] double top_speed() const noexcept {
    return std::numbers::pi / duration * along_W.norm();
  }

  /// Places the body where it is `time` [s] after the start. False when that is no sound pose: the
  /// body stays where it was.
  [[nodiscard]] bool place(World& world, double time) const noexcept {
    const double turn = 2.0 * std::numbers::pi / duration;
    Pose X = X_WB;
    X.translation() += 0.5 * (1.0 - std::cos(turn * time)) * along_W;
    return world.place(body, X, {0.5 * turn * std::sin(turn * time) * along_W, Vec3::Zero()});
  }
};

}  // namespace repel
