// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The result of the last evaluation of a pair, and the distance bound it gives at a later tick.
#pragma once

#include <algorithm>
#include <cstdint>

#include <repel/base/spatial.hpp>
#include <repel/force/law.hpp>
#include <repel/pairs/pair_geometry.hpp>
#include <repel/reduction/separation_result.hpp>

namespace repel::detail {

/// The share of its force that a pair still exerts when it has waited for an evaluation for `age`
/// ticks: all of it up to `max_age`, then less, and nothing from twice that on.
[[nodiscard]] inline double share_of_stale(std::int64_t age, std::int64_t max_age) noexcept {
  const double fade = static_cast<double>(age - max_age) / static_cast<double>(max_age);
  return 1.0 - std::clamp(fade, 0.0, 1.0);
}

/// Conservative lower bound [m] of a signed distance that was at least `bound` [m] before body A
/// moved by `moved` [m] from body B, and the turning of both took up to `turned` [m]. If the shapes
/// were apart, the separating plane remains valid when shifted by the motion along its normal,
/// `direction`; in overlap the distance decreases no faster than the bodies move. `lean` [rad]: by
/// which the separating planes of a contact patch may be off `direction`. No answer is deeper than
/// World::deepest; this bound may be.
[[nodiscard]] inline double bound_after(double bound, bool is_apart, const Vec3& direction,
                                        double lean, const Vec3& moved, double turned) noexcept {
  const double off = lean > 0.0 ? lean * norm(moved) : 0.0;
  return bound + (is_apart ? dot(direction, moved) - off : -norm(moved)) - turned;
}

/// The data the force of a pair is computed from, at the tick of its evaluation and later. What
/// `lower_bound` needs comes first: it is asked of hundreds of pairs that are not near.
struct alignas(64) PairAnswer {
  static constexpr std::size_t bytes_of_bound = 192;  ///< at its beginning

  Separation last;
  double nearer = 0.0;        ///< [m] the distance minus that of the contact patch
  Vec3 p_BA_W{0, 0, 0};       ///< [m] origin of body A from that of body B at the evaluation
  double turn = 0.0;          ///< [m] both bodies' BodyState::turn at the evaluation
  bool in_range = false;      ///< of its law, at the evaluation
  bool is_watched = false;    ///< out of its range, and within ForceLaw::watched
  bool is_stale = false;      ///< a force was computed from it at a later tick
  double slope = 1.0;         ///< of the distance along the extraction; passable pairs only
  Wrench gradient;            ///< of the patch's distance when A moves, about the origin of body A
  Vec3 p_AQ_W{0, 0, 0};       ///< [m] witness point on A, from the origin of body A
  std::int64_t tick = never;  ///< of the motion that was evaluated
  std::int64_t evaluated_at = never;  ///< the same on the tick counter of the evaluator
  std::int64_t pushed_at = never;     ///< last time a force was computed from it, same counter
  std::int64_t waits_since = 0;       ///< [ticks] since when the pair is near but not evaluated
  double assumed = 0.0;  ///< [m] for a stale pair about to be evaluated: see `note_assumed`
  double force = 0.0;    ///< [N] last computed from it

  static constexpr std::int64_t never = INT64_MIN;

  [[nodiscard]] bool known() const noexcept { return tick > never; }
  /// A signed distance [m] of the contact patch that is not larger than the true one. The measured
  /// distance of a query that ran out of budget has no matching direction: only its lower bound is
  /// used.
  [[nodiscard]] double proven() const noexcept {
    return (cut_short() ? last.lower : proven_distance(last.distance, last.lower)) - nearer;
  }

  /// [ticks] How long the pair has waited for an evaluation; a watched one needs none.
  [[nodiscard]] std::int64_t age(std::int64_t now) const noexcept {
    return is_watched ? 0 : now - waits_since;
  }

  /// A plane separates the shapes, with the extraction direction as its normal.
  [[nodiscard]] bool is_apart() const noexcept { return last.lower > 0.0 && !cut_short(); }

  /// Lower bound of the signed distance [m] now: bound_after.
  [[nodiscard]] double lower_bound(const BodyState& A, const BodyState& B) const noexcept {
    return bound_after(proven(), is_apart(), last.extraction_W,
                       nearer != 0.0 ? ForceLaw::most_tilt : 0.0,
                       origin(A.X_WB) - origin(B.X_WB) - p_BA_W, A.turn + B.turn - turn);
  }

 private:
  [[nodiscard]] bool cut_short() const noexcept { return last.end == QueryEnd::budget_spent; }
};

}  // namespace repel::detail
