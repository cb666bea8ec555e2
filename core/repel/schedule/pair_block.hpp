/// @file
/// A share of the pairs that is worked through together: which are due, what is still known of
/// the others, and the forces of all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/schedule/pair_memory.hpp>
#include <repel/schedule/part_poses.hpp>

namespace repel {

/// How much a tick may cost.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick, all blocks together; 0 = no limit.
                                ///< Each block finishes the pair it is at
  std::chrono::nanoseconds wall{0};  ///< per tick and thread; 0 = no limit
};

namespace detail {

/// A share of the world's pairs. Those that can soon come within range are its candidates; each has
/// a slot of memory, which it keeps until another needs it. All memory is taken at construction.
class PairBlock {
 public:
  /// @param slots for at most so many pairs, at least 0
  PairBlock(const World& world, PairShare share, int slots)
      : world_(&world), memory_(world, share, slots) {
    forces_.on_body.resize(world.body_count());
    candidates_.reserve(memory_.slots());
  }

  /// Evaluates every pair once, so that none enters the first tick unknown, and forgets the forces.
  void prime(const Motion& motion, PartPoses& poses) noexcept {
    for (int place = 0; place < memory_.pairs(); ++place) {
      evaluate(memory_.slot_for(memory_.share().pair_at(place)), motion, poses);
    }
    forces_.clear();
  }

  /// Begins a tick: no force yet.
  void begin(std::int64_t tick) noexcept {
    if (forces_.totals.near > 0 || forces_.totals.crowded > 0) forces_.clear();
    forces_.tick = tick;
  }

  /// Makes a pair a candidate. False when there is no slot for it: then it is evaluated at once,
  /// from a cold start, if it can be near.
  /// @param distance [m] proven from below
  bool take(PairId id, std::int32_t seeker, double distance, const Motion& motion,
            PartPoses& poses) noexcept {
    const int slot = memory_.slot_for(id);
    watch_for(slot, motion, distance - pair(slot).law.range);
    if (memory_.is_lent(slot)) {
      ++forces_.totals.crowded;
      if (is_near(slot, motion)) {
        ++forces_.totals.near;
        evaluate(slot, motion, poses);
        push(slot, motion, memory_.answer(slot).distance);
      }
      return false;
    }
    memory_.watch(slot).taken = true;
    if (memory_.enlist(slot, seeker)) {
      candidates_.push_back(slot);
      grown_ = true;
    }
    return true;
  }

  /// The list of that seeker is complete: those of its candidates that were not taken are none now.
  void end(std::int32_t seeker) noexcept {
    const auto is_left = [&](std::int32_t slot) {
      PairWatch& watch = memory_.watch(slot);
      const bool left = watch.seeker == seeker && !watch.taken;
      if (left) memory_.strike(slot);
      watch.taken = false;
      return left;
    };
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(), is_left),
                      candidates_.end());
    // In the order of the slots the turn of each comes, whoever joins.
    if (grown_) std::sort(candidates_.begin(), candidates_.end());
    grown_ = false;
  }

  /// Works through the candidates until `work_units` are spent or `deadline` is reached, beginning
  /// where the last tick had to stop, so that no pair starves. The pair in hand is finished: half
  /// an answer would cost most of a whole one and might say less than the old one. And a pair
  /// without any answer is asked in any case.
  void run(const Motion& motion, PartPoses& poses, std::int64_t work_units,
           std::chrono::steady_clock::time_point deadline) noexcept {
    const auto begin = std::lower_bound(candidates_.begin(), candidates_.end(), cursor_);
    bool spent = false;
    const auto visit = [&](std::int32_t i) {
      if (!is_near(i, motion)) return;
      const double least = widened(i, motion);
      if (least > pair(i).law.range) {
        watch_for(i, motion, least - pair(i).law.range);
        return;
      }
      ++forces_.totals.near;
      const std::int64_t left = work_units - forces_.totals.iterations;
      if (!spent && is_spent(left, deadline)) {
        spent = true;
        cursor_ = i;
      }
      if (spent && memory_.answer(i).tick > PairAnswer::never) {
        count_stale(motion.tick - memory_.answer(i).tick);
        push(i, motion, least);
      } else {
        evaluate(i, motion, poses);
        push(i, motion, memory_.answer(i).distance);
      }
    };
    std::for_each(begin, candidates_.end(), visit);
    std::for_each(candidates_.begin(), begin, visit);
  }

  /// Asks up to `most` pairs again that were near at the last tick, and forgets the answers.
  /// Returns how many.
  int rehearse(const Motion& motion, const PartPoses& poses, int most) const noexcept {
    int asked = 0;
    for (const std::int32_t i : candidates_) {
      if (asked >= most) break;
      if (!is_near(i, motion)) continue;
      WarmStart warm = memory_.query(i).warm;
      const Pair& p = pair(i);
      (void)separation(world_->part(p.a).shape, poses.last(p.a), world_->part(p.b).shape,
                       poses.last(p.b), {}, warm);
      ++asked;
    }
    return asked;
  }

  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }
  /// The last answer that is remembered; the default one, which claims nothing, where none is.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const int slot = memory_.slot_of(id);
    return slot == PairMemory::none ? Separation{} : memory_.query(slot).last;
  }
  [[nodiscard]] const PairExtremes& extremes_of(PairId id) const noexcept {
    return memory_.extremes(id);
  }
  [[nodiscard]] const PairMemory& memory() const noexcept { return memory_; }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] static bool is_spent(std::int64_t units, Clock::time_point deadline) noexcept {
    if (units <= 0) return true;
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
  }

  [[nodiscard]] const Pair& pair(int i) const noexcept {
    return world_->pair(memory_.watch(i).pair);
  }
  [[nodiscard]] const BodyState& body_a(int i, const Motion& motion) const noexcept {
    return motion.bodies[memory_.watch(i).body_a.index];
  }
  [[nodiscard]] const BodyState& body_b(int i, const Motion& motion) const noexcept {
    return motion.bodies[memory_.watch(i).body_b.index];
  }

  [[nodiscard]] PairExtremes& extremes(int i) noexcept {
    return memory_.extremes(memory_.watch(i).pair);
  }

  /// A pair whose bodies together have not travelled its clearance since it was evaluated cannot
  /// have come within range: it costs this comparison and nothing else. One that might by that
  /// count is looked at once more, along the direction that parts it (`widened`).
  [[nodiscard]] bool is_near(int i, const Motion& motion) const noexcept {
    return body_a(i, motion).travel + body_b(i, motion).travel >= memory_.watch(i).due_at;
  }

  /// @param clearance [m] what the bodies may travel before the pair can be within range. What was
  /// proven before holds as well.
  void watch_for(int i, const Motion& motion, double clearance) noexcept {
    if (!(clearance > 0.0)) return;
    double& due_at = memory_.watch(i).due_at;
    due_at = std::max(due_at, body_a(i, motion).travel + body_b(i, motion).travel + clearance);
  }

  void evaluate(int i, const Motion& motion, PartPoses& poses) noexcept {
    const Pair& p = pair(i);
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Shape& shape_a = world_->part(p.a).shape;
    const Shape& shape_b = world_->part(p.b).shape;
    const Pose& X_WPa = poses.at(p.a, motion);
    const Pose& X_WPb = poses.at(p.b, motion);
    Separation& s = memory_.query(i).last;
    s = separation(shape_a, X_WPa, shape_b, X_WPb, {}, memory_.query(i).warm);
    // A query that was cut short is answered by its proven bound, whose direction is not known.
    const bool cut_short = s.end == QueryEnd::budget_spent;
    const double slope = p.law.passable ? slope_of(s, shape_a, X_WPa, shape_b, X_WPb, {},
                                                   memory_.query(i).warm, s.iterations)
                                        : 1.0;
    memory_.answer(i) = {cut_short || s.lower > 0.0 ? s.lower : s.distance,
                         s.lower > 0.0 && !cut_short,
                         s.extraction_W,
                         slope,
                         s.p_WA - A.X_WB.translation(),
                         A.X_WB.translation() - B.X_WB.translation(),
                         A.turn + B.turn,
                         motion.tick};
    watch_for(i, motion, s.lower - p.law.range);
    PairTotals& totals = forces_.totals;
    ++totals.evaluated;
    totals.iterations += s.iterations;
    double& nearest = extremes(i).nearest;
    nearest = std::min(nearest, s.distance);
    if (s.distance < totals.nearest) {
      totals.nearest = s.distance;
      totals.nearest_pair = memory_.watch(i).pair;
    }
  }

  /// The least signed distance the pair can have now. While apart, the plane across the extraction
  /// direction still parts the shapes once it is moved by what they have moved along it; in overlap
  /// the distance falls no faster than the bodies move. Rotation takes at most `turn` either way.
  /// And no answer is ever deeper than both shapes' last levels.
  [[nodiscard]] double widened(int i, const Motion& motion) const noexcept {
    const PairAnswer& then = memory_.answer(i);
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Vec3 moved = A.X_WB.translation() - B.X_WB.translation() - then.p_BA_W;
    const double along = then.parted ? then.extraction_W.dot(moved) : -moved.norm();
    const double turned = A.turn + B.turn - then.turn;
    const double now = then.distance + along - turned;
    if (now > 0.0) return now;
    const Pair& p = pair(i);
    return std::max(now, -world_->part(p.a).shape.deepest() - world_->part(p.b).shape.deepest());
  }

  void count_stale(std::int64_t age) noexcept {
    ++forces_.totals.stale;
    forces_.totals.oldest_age = std::max(forces_.totals.oldest_age, age);
  }

  /// The force of the pair at that distance, on both bodies.
  void push(int i, const Motion& motion, double distance) noexcept {
    const ForceLaw& law = pair(i).law;
    if (!(distance < law.range)) return;
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Vec3& n = memory_.answer(i).extraction_W;
    const Vec3& p_AQ_W = memory_.answer(i).p_AQ_W;
    const Vec3 p_BQ_W = p_AQ_W + A.X_WB.translation() - B.X_WB.translation();
    const Vec3 v_A = moved_to(A.V_WB, p_AQ_W).linear;
    const Vec3 v_B = moved_to(B.V_WB, p_BQ_W).linear;
    const Vec3 v_BA = v_A - v_B;
    double size = 0.0;
    Vec3 f;
    if (law.passable) {
      f = memory_.query(i).passage.force(law, distance, memory_.answer(i).slope * n,
                                         A.travel + B.travel, v_BA);
      size = f.norm();
    } else {
      size = law(distance, n.dot(v_BA));
      f = size * n;
    }
    forces_.totals.peak_force = std::max(forces_.totals.peak_force, size);
    double& peak = extremes(i).peak_force;
    peak = std::max(peak, size);
    forces_.on_body[memory_.watch(i).body_a.index] += wrench_of_force(f, p_AQ_W);
    forces_.on_body[memory_.watch(i).body_b.index] += wrench_of_force(-f, p_BQ_W);
  }

  const World* world_;
  PairMemory memory_;
  std::vector<std::int32_t> candidates_;  ///< slots, in their order between two searches
  bool grown_ = false;                    ///< a candidate stands out of order
  int cursor_ = 0;                        ///< the slot at which the next tick begins
  PairForces forces_;
};

}  // namespace detail
}  // namespace repel
