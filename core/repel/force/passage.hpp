// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force during the passage through a passable body.
#pragma once

#include <algorithm>
#include <limits>

#include <repel/force/law.hpp>
#include <repel/reduction/separation.hpp>

namespace repel {

/// The slope of the signed distance along the extraction direction, 0 to 1. It is 1 while the
/// shapes are apart; in overlap it can be less, and a force that ignored it would return more
/// energy on the far side of a membrane than it absorbed, or less.
/// @param s the result of `separation` for these shapes at these poses
/// @param warm the warm start it left
/// @param iterations is increased by the support-map pairs used
/// Cost: in overlap a warm-started call of `separation`, else nothing.
[[nodiscard]] inline double slope_of(const Separation& s, PosedShape A, PosedShape B,
                                     const QueryOptions& options, WarmStart warm,
                                     int& iterations) noexcept {
  if (!(s.distance < 0.0)) return 1.0;
  const double step = 1e-6 * (A.shape.reach() + B.shape.reach());
  Pose X_WA_on = A.X_W;
  set_column(X_WA_on, 3, Vec<double>(origin(A.X_W) + step * s.extraction_W));
  const Separation on = separation(A.shape, X_WA_on, B.shape, B.X_W, options, warm);
  iterations += on.iterations;
  return std::clamp((on.distance - s.distance) / step, 0.0, 1.0);
}

/// The spring of one passable pair as a vector. That of the law is the gradient of a potential,
/// s(d) grad d, but in overlap this gradient can jump: backwards while a tool enters, sideways near
/// an edge, forwards when it leaves. The fall of s(d) covers the reversal in the middle of a
/// passage. For all other jumps the spring follows that of the law with a rate limit, its stiffness
/// times the motion, and is never larger than s(d). So
///
///     |change of the spring| <= stiffness() x motion
///
/// on every path, and the spring does not change at standstill. The lag only absorbs energy:
/// docs/control.md.
class Passage {
 public:
  /// Moves the spring towards that of the law.
  /// @param law of a passable body
  /// @param distance [m] signed
  /// @param gradient_W of the distance when A moves: the extraction direction times `slope_of`
  /// @param travel [m] distance travelled by both bodies; never decreases. The first call is not
  /// limited
  /// @return the spring on A [N], world axes.
  const Vec3& follow(const ForceLaw& law, double distance, const Vec3& gradient_W,
                     double travel) noexcept {
    const double largest = law.passing_spring(distance);
    double allowed = law.stiffness() * (travel - travel_);
    travel_ = travel;
    const double size = norm(spring_W_);
    if (size > largest) {
      spring_W_ = largest / size * spring_W_;
      allowed -= size - largest;
    }
    const Vec3 lag_W = largest * gradient_W - spring_W_;
    const double lag = norm(lag_W);
    if (lag > 0.0) spring_W_ += std::clamp(allowed / lag, 0.0, 1.0) * lag_W;
    return spring_W_;
  }

  /// The force on A [N], world axes: the spring after `follow`, damped along itself.
  /// @param v_BA_W [m/s] of A relative to B at the point of action
  [[nodiscard]] Vec3 force(const ForceLaw& law, double distance, const Vec3& gradient_W,
                           double travel, const Vec3& v_BA_W) noexcept {
    const Vec3& spring_W = follow(law, distance, gradient_W, travel);
    const double size = norm(spring_W);
    if (!(size > 0.0)) return {0, 0, 0};
    const Vec3 way_W = spring_W / size;
    return law.damped(size, dot(way_W, v_BA_W)) * way_W;
  }

 private:
  Vec3 spring_W_{0, 0, 0};                                    ///< [N]
  double travel_ = -std::numeric_limits<double>::infinity();  ///< [m] at the last call
};

}  // namespace repel
