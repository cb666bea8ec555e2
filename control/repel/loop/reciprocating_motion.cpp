// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/reciprocating_motion.hpp>

#include <cmath>
#include <numbers>

#include <repel/base/vec.hpp>

namespace repel {

Vec3 ReciprocatingMotion::offset(double time) const noexcept {
  return 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi / duration * time)) * along_W;
}

double ReciprocatingMotion::top_speed() const noexcept {
  return std::numbers::pi / duration * along_W.norm();
}

bool MovingBody::place(World& world, double time) const noexcept {
  const double turn = 2.0 * std::numbers::pi / motion.duration;
  Pose X = X_WB;
  set_column(X, 3, Vec<double>(origin(X_WB) + motion.offset(time)));
  return world.place(body, X, {0.5 * turn * std::sin(turn * time) * motion.along_W, {0, 0, 0}});
}

}  // namespace repel
