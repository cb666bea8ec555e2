/// @file
/// What the last evaluation of a pair has left, and what it still proves at a later instant.
#pragma once

#include <algorithm>
#include <cstdint>

#include <repel/reduction/answer.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// What the force of a pair needs, also when the pair could not be evaluated again.
struct PairAnswer {
  Separation last;
  double slope = 1.0;            ///< of the distance along the extraction; of passable pairs only
  Vec3 p_AQ_W{0, 0, 0};          ///< [m] witness point on A, from the origin of body A
  Vec3 p_BA_W{0, 0, 0};          ///< [m] origin of body A from that of body B when it was evaluated
  double turn = 0.0;             ///< [m] both bodies' BodyState::turn then
  std::int64_t tick = never;     ///< when it was evaluated
  std::int64_t asked = never;    ///< the same in the count of its evaluator
  std::int64_t pushed = never;   ///< the last force was made of it then, in the same count
  std::int64_t waits_since = 0;  ///< [ticks] since when it is near without a newer answer
  bool inside = false;           ///< within range then
  bool is_stale = false;         ///< a force was made of it at a later tick
  double claimed = 0.0;          ///< [m] when it was stale: the distance it was taken for at last
  double force = 0.0;            ///< [N] that was made of it at last

  static constexpr std::int64_t never = INT64_MIN;

  [[nodiscard]] bool known() const noexcept { return tick > never; }
  /// What it proves of the signed distance from below [m]. The direction of a query that was cut
  /// short is not known.
  [[nodiscard]] double proven() const noexcept {
    return cut_short() || last.lower > 0.0 ? last.lower : last.distance;
  }

  /// The least signed distance the pair can have now. While apart, the plane across the extraction
  /// direction still parts the shapes once it is moved by what they have moved along it; in overlap
  /// the distance falls no faster than the bodies move. Rotation takes at most `turn` either way.
  /// And no answer is ever deeper than both shapes' last levels.
  /// @param deepest [m] that any answer can be, as a positive number
  [[nodiscard]] double widened(const BodyState& A, const BodyState& B,
                               double deepest) const noexcept {
    const Vec3 moved = A.X_WB.translation() - B.X_WB.translation() - p_BA_W;
    const bool parted = last.lower > 0.0 && !cut_short();
    const double along = parted ? last.extraction_W.dot(moved) : -moved.norm();
    const double now = proven() + along - (A.turn + B.turn - turn);
    return now > 0.0 ? now : std::max(now, -deepest);
  }

 private:
  [[nodiscard]] bool cut_short() const noexcept { return last.end == QueryEnd::budget_spent; }
};

}  // namespace repel::detail
