// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The answer of a near pair in a form from which another thread can compute its force later.
#pragma once

#include <repel/base/spatial.hpp>
#include <repel/force/law.hpp>
#include <repel/pairs/pair_answer.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// What is known of a near pair at the motion it was answered for.
struct NearAnswer {
  Wrench gradient;     ///< of its distance when A moves, about the origin of body A; of a passable
                       ///< pair, the force on A [N, N m]
  double bound = 0.0;  ///< [m] lower bound of the signed distance
  double share = 1.0;  ///< of the force: less for an answer that has expired
  PairId pair;
  BodyId a, b;
  bool is_apart = false;     ///< a plane separates the shapes
  bool has_patch = false;    ///< the gradient is that of a contact patch
  bool is_passable = false;  ///< the force is held as it is
};

/// How a body has moved since: the differences of its state.
struct MotionSince {
  Vec3 moved{0, 0, 0};  ///< [m] its origin
  double turn = 0.0;    ///< [m] BodyState::turn

  [[nodiscard]] static MotionSince between(const BodyState& then, const BodyState& now) noexcept {
    return {origin(now.X_WB) - origin(then.X_WB), now.turn - then.turn};
  }
};

/// A lower bound [m] of the signed distance after both bodies have moved. If the shapes were apart,
/// the separating plane remains valid when shifted by the relative motion along its normal; in
/// overlap the distance decreases no faster than the bodies move. Rotation subtracts at most the
/// increase of `turn` in both cases. The planes that separate the shapes of a patch, and the
/// gradient of its distance, lean by up to its tilt.
/// No answer is deeper than World::deepest; this bound may be.
[[nodiscard]] inline double bound_after(const NearAnswer& answer, const MotionSince& of_a,
                                        const MotionSince& of_b) noexcept {
  constexpr double widest_lean = 2.0 * ForceLaw::most_tilt;  // [rad]
  const Vec3 moved = of_a.moved - of_b.moved;
  const double length = norm(moved);
  const double along = answer.is_apart ? dot(answer.gradient.force, moved) -
                                             (answer.has_patch ? widest_lean * length : 0.0)
                                       : -length;
  return answer.bound + along - (of_a.turn + of_b.turn);
}

}  // namespace repel::detail
