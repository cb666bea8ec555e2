/// @file
/// Answers single pairs and turns answers, new or old, into forces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include <repel/reduction/separation.hpp>
#include <repel/schedule/near_pair.hpp>
#include <repel/schedule/pair_memory.hpp>
#include <repel/schedule/part_poses.hpp>

namespace repel::detail {

/// Works on the pairs that have a slot of its memory. All memory is taken at construction.
class PairEvaluator {
 public:
  /// @param slots for at most so many pairs, at least 0
  /// @param max_age [ticks] `Budget::max_age`
  PairEvaluator(const World& world, PairShare share, int slots, std::int64_t max_age)
      : world_(&world), max_age_(max_age), memory_(world, share, slots) {
    forces_ = PairForces(world.body_count());
  }

  /// Begins a tick: no force yet, and no answer is of it.
  void begin(std::int64_t tick) noexcept {
    if (forces_.totals.near > 0 || forces_.totals.crowded > 0) forces_.clear();
    forces_.tick = tick;
    ++now_;
  }

  [[nodiscard]] const World& world() const noexcept { return *world_; }
  [[nodiscard]] PairMemory& memory() noexcept { return memory_; }
  [[nodiscard]] const PairMemory& memory() const noexcept { return memory_; }
  [[nodiscard]] PairForces& forces() noexcept { return forces_; }
  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }

  [[nodiscard]] const Pair& pair(int slot) const noexcept {
    return world_->pair(memory_.watch(slot).pair);
  }
  [[nodiscard]] const BodyState& body_a(int slot, const Motion& motion) const noexcept {
    return motion.bodies[memory_.watch(slot).body_a.index];
  }
  [[nodiscard]] const BodyState& body_b(int slot, const Motion& motion) const noexcept {
    return motion.bodies[memory_.watch(slot).body_b.index];
  }

  /// A pair whose bodies together have not travelled its clearance since it was evaluated cannot
  /// have come within range: it costs this comparison and nothing else.
  [[nodiscard]] bool is_due(int slot, const Motion& motion) const noexcept {
    return body_a(slot, motion).travel + body_b(slot, motion).travel >= memory_.watch(slot).due_at;
  }

  /// @param clearance [m] what the bodies may travel before the pair can be within range. What was
  /// proven before holds as well.
  void watch_for(int slot, const Motion& motion, double clearance) noexcept {
    if (!(clearance > 0.0)) return;
    double& due_at = memory_.watch(slot).due_at;
    const double travel = body_a(slot, motion).travel + body_b(slot, motion).travel;
    due_at = std::max(due_at, travel + clearance);
  }

  /// The least signed distance [m] the pair can have now, by its last answer.
  [[nodiscard]] double widened(int slot, const Motion& motion) const noexcept {
    const Pair& p = pair(slot);
    const double deepest = world_->part(p.a).shape.deepest() + world_->part(p.b).shape.deepest();
    return memory_.answer(slot).widened(body_a(slot, motion), body_b(slot, motion), deepest);
  }

  /// [m] How much of that bound the turning of the bodies has taken.
  [[nodiscard]] double turned(int slot, const Motion& motion) const noexcept {
    return body_a(slot, motion).turn + body_b(slot, motion).turn - memory_.answer(slot).turn;
  }

  /// The same by the shapes themselves as they stand now, along the extraction direction of that
  /// answer. Cost: a support-map pair.
  [[nodiscard]] double parted_by(int slot, const Motion& motion, PartPoses& poses) const noexcept {
    const Pair& p = pair(slot);
    return -overlap_along(memory_.answer(slot).last.extraction_W, world_->part(p.a).shape,
                          poses.at(p.a, motion), world_->part(p.b).shape, poses.at(p.b, motion)) -
           rounding;
  }

  /// [s] until the pair touches if both bodies go on as they do; the less the more urgent.
  [[nodiscard]] double time_to_contact(int slot, const Motion& motion) const noexcept {
    const double closing = -memory_.answer(slot).last.extraction_W.dot(velocity(slot, motion));
    const double distance = widened(slot, motion);
    return closing > 0.0 || distance < 0.0 ? distance / std::max(closing, 1e-3) : 1e9;
  }

  /// The pair is on no list any more, being out of reach.
  void drop(int slot) noexcept {
    memory_.answer(slot).inside = false;
    memory_.strike(slot);
  }

  /// The last tick's answer of the pair is what `answer` has from now on, and a force was made of
  /// it.
  void put(int slot, const PairAnswer& answer) noexcept {
    memory_.answer(slot) = answer;
    memory_.answer(slot).pushed = now_ - 1;
  }

  /// The pair was asked anew since `begin`.
  [[nodiscard]] bool is_fresh(int slot) const noexcept {
    return memory_.answer(slot).asked == now_;
  }

  /// What follows when a pair comes within range is to depend on its motion there alone, not on how
  /// often it was asked before: the first question of a pair that has come there has no warm start.
  void forget_course(int slot) noexcept { memory_.course(slot) = {}; }

  /// The pair of a slot asked anew.
  void evaluate(int slot, const Motion& motion, PartPoses& poses) noexcept {
    PairAnswer& answer = memory_.answer(slot);
    keep_claim(slot, motion);
    const WarmStart& warm = memory_.course(slot).warm;
    const bool is_warm = warm.size > 0 || warm.level_a > 0;
    answer.last = ask(slot, motion, poses, memory_.course(slot).warm);
    ++forces_.totals.evaluated;
    forces_.totals.iterations += answer.last.iterations;
    if (is_warm && !answer.inside && answer.last.lower <= pair(slot).law.range + rounding) {
      forget_course(slot);
      answer.last = ask(slot, motion, poses, memory_.course(slot).warm);
      forces_.totals.iterations += answer.last.iterations;
    }
    settle(slot, motion, poses);
  }

  /// Asks the pair again as it was at the last tick and forgets the answer.
  void rehearse(int slot, const PartPoses& poses) const noexcept {
    WarmStart warm = memory_.course(slot).warm;
    const Pair& p = pair(slot);
    (void)separation(world_->part(p.a).shape, poses.last(p.a), world_->part(p.b).shape,
                     poses.last(p.b), {}, warm);
  }

  /// The force of the pair by its last answer, on both bodies: as it stands at the tick of that
  /// answer, and widened afterwards.
  void push(int slot, const Motion& motion) noexcept {
    PairAnswer& answer = memory_.answer(slot);
    answer.is_stale = answer.asked != now_;
    // While a pair was out of reach nobody waited for its answer.
    if (answer.pushed != now_ - 1) answer.waits_since = motion.tick - 1;
    answer.pushed = now_;
    if (!answer.is_stale) {
      answer.waits_since = motion.tick;
      return push_at(answer.proven(), 1.0, slot, motion);
    }
    const std::int64_t age = motion.tick - answer.waits_since;
    PairTotals& totals = forces_.totals;
    ++totals.stale;
    totals.oldest_age = std::max(totals.oldest_age, age);
    totals.expired += age > max_age_ ? 1 : 0;
    const double fade = static_cast<double>(age - max_age_) / static_cast<double>(max_age_);
    push_at(widened(slot, motion), 1.0 - std::clamp(fade, 0.0, 1.0), slot, motion);
  }

  /// What a display gets of the pair, by its memory: nothing if it was neither asked nor used at
  /// the tick of `motion`.
  [[nodiscard]] std::optional<NearPair> near_pair(int slot, const Motion& motion) const noexcept {
    const PairAnswer& answer = memory_.answer(slot);
    const bool stale = answer.tick != motion.tick;
    if (stale && answer.pushed != now_) return std::nullopt;
    return NearPair{memory_.watch(slot).pair, answer.last, answer.force, stale,
                    stale ? motion.tick - answer.waits_since : 0};
  }

  /// Before a pair is asked anew whose force was widened: notes what it would be taken for now if
  /// it were not asked.
  void keep_claim(int slot, const Motion& motion) noexcept {
    PairAnswer& answer = memory_.answer(slot);
    if (answer.is_stale) answer.claimed = widened(slot, motion);
  }
  /// Afterwards. @param distance [m] that the pair turned out to have
  void note_refresh(int slot, double distance) noexcept {
    const ForceLaw& law = pair(slot).law;
    const double claimed = memory_.answer(slot).claimed;
    forces_.totals.refresh_energy +=
        std::max(0.0, law.potential(claimed) - law.potential(distance));
  }

 private:
  /// [m] More than two answers to one question differ by.
  static constexpr double rounding = 1e-9;

  [[nodiscard]] Separation ask(int slot, const Motion& motion, PartPoses& poses,
                               WarmStart& warm) noexcept {
    const Pair& p = pair(slot);
    return separation(world_->part(p.a).shape, poses.at(p.a, motion), world_->part(p.b).shape,
                      poses.at(p.b, motion), {}, warm);
  }

  /// Takes note of a new answer.
  void settle(int slot, const Motion& motion, PartPoses& poses) noexcept {
    const Pair& p = pair(slot);
    PairAnswer& answer = memory_.answer(slot);
    PairTotals& totals = forces_.totals;
    if (p.law.passable) {
      int iterations = 0;
      answer.slope = slope_of(answer.last, world_->part(p.a).shape, poses.at(p.a, motion),
                              world_->part(p.b).shape, poses.at(p.b, motion), {},
                              memory_.course(slot).warm, iterations);
      totals.iterations += iterations;
    } else if (answer.is_stale) {
      note_refresh(slot, answer.proven());
    }
    const BodyState& A = body_a(slot, motion);
    const BodyState& B = body_b(slot, motion);
    answer.p_AQ_W = answer.last.p_WA - A.X_WB.translation();
    answer.p_BA_W = A.X_WB.translation() - B.X_WB.translation();
    answer.turn = A.turn + B.turn;
    answer.tick = motion.tick;
    answer.asked = now_;
    answer.inside = answer.proven() < p.law.range;
    watch_for(slot, motion, answer.last.lower - p.law.range);
    const PairId id = memory_.watch(slot).pair;
    const double deepest = std::max(0.0, -answer.last.lower);
    totals.deepest = std::max(totals.deepest, deepest);
    memory_.extremes(id).add({.nearest = answer.last.distance, .deepest = deepest});
    if (answer.last.distance < totals.nearest) {
      totals.nearest = answer.last.distance;
      totals.nearest_pair = id;
    }
  }

  /// Velocity of A against B [m/s] at the witness point of the last answer.
  [[nodiscard]] Vec3 velocity(int slot, const Motion& motion) const noexcept {
    const BodyState& A = body_a(slot, motion);
    const BodyState& B = body_b(slot, motion);
    const Vec3& p_AQ_W = memory_.answer(slot).p_AQ_W;
    const Vec3 p_BQ_W = p_AQ_W + A.X_WB.translation() - B.X_WB.translation();
    return moved_to(A.V_WB, p_AQ_W).linear - moved_to(B.V_WB, p_BQ_W).linear;
  }

  /// The force of the pair at that distance, times `share`.
  void push_at(double distance, double share, int slot, const Motion& motion) noexcept {
    const ForceLaw& law = pair(slot).law;
    memory_.answer(slot).force = 0.0;
    if (!(distance < law.range)) return;
    const BodyState& A = body_a(slot, motion);
    const BodyState& B = body_b(slot, motion);
    const PairAnswer& answer = memory_.answer(slot);
    const Vec3& n = answer.last.extraction_W;
    const Vec3 v_BA = velocity(slot, motion);
    double size = 0.0;
    Vec3 f;
    if (law.passable) {
      f = share * memory_.course(slot).passage.force(law, distance, answer.slope * n,
                                                     A.travel + B.travel, v_BA);
      size = f.norm();
    } else {
      size = share * law(distance, n.dot(v_BA));
      f = size * n;
    }
    memory_.answer(slot).force = size;
    const PairId id = memory_.watch(slot).pair;
    forces_.totals.note_force(size, id);
    double& peak = memory_.extremes(id).peak_force;
    peak = std::max(peak, size);
    const Vec3 p_BQ_W = answer.p_AQ_W + A.X_WB.translation() - B.X_WB.translation();
    const PairWatch& watch = memory_.watch(slot);
    forces_.push(watch.body_a, watch.body_b, wrench_of_force(f, answer.p_AQ_W),
                 wrench_of_force(-f, p_BQ_W), motion);
  }

  const World* world_;
  std::int64_t max_age_;  ///< [ticks]
  std::int64_t now_ = 0;  ///< counts the ticks begun
  PairMemory memory_;
  PairForces forces_;
};

}  // namespace repel::detail
