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

/// Lower bound [m] of the signed distance after both bodies have moved. The gradient of a patch
/// leans by up to the tilt, and so do its separating planes.
[[nodiscard]] inline double bound_after(const NearAnswer& answer, const MotionSince& of_a,
                                        const MotionSince& of_b) noexcept {
  return bound_after(answer.bound, answer.is_apart, answer.gradient.force,
                     answer.has_patch ? 2.0 * ForceLaw::most_tilt : 0.0, of_a.moved - of_b.moved,
                     of_a.turn + of_b.turn);
}

}  // namespace repel::detail
