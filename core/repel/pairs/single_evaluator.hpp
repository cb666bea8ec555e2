// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Evaluates pairs one by one, and computes forces from their answers, fresh or stale.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include <repel/contact/patch.hpp>
#include <repel/pairs/near_pair.hpp>
#include <repel/pairs/pair_memory.hpp>
#include <repel/pairs/part_poses.hpp>
#include <repel/reduction/separation.hpp>

namespace repel::detail {

/// Evaluates the pairs of a memory, each known by its slot, and adds their forces to a sum.
class SingleEvaluator {
 public:
  /// @param memory,forces of the pairs of `world`; must outlive this object
  /// @param max_age [ticks] `Budget::max_age`
  SingleEvaluator(const World& world, PairMemory& memory, PairForces& forces, std::int64_t max_age)
      : world_(&world), memory_(&memory), forces_(&forces), max_age_(max_age) {}

  /// Begins a tick: clears the forces; no answer is of this tick.
  void begin_tick(std::int64_t tick) noexcept {
    if (forces_->totals.near > 0 || forces_->totals.crowded > 0) forces_->clear();
    forces_->tick = tick;
    ++now_;
  }

  [[nodiscard]] const World& world() const noexcept { return *world_; }
  [[nodiscard]] std::int64_t max_age() const noexcept { return max_age_; }

  [[nodiscard]] const Pair& pair(int slot) const noexcept {
    return world_->pair(memory_->tracking(slot).pair);
  }
  /// [m] The distance within which the pair is near.
  [[nodiscard]] double reach(int slot) const noexcept { return memory_->tracking(slot).reach; }
  [[nodiscard]] const BodyState& body_a(int slot, const Motion& motion) const noexcept {
    return motion.bodies[memory_->tracking(slot).body_a.index];
  }
  [[nodiscard]] const BodyState& body_b(int slot, const Motion& motion) const noexcept {
    return motion.bodies[memory_->tracking(slot).body_b.index];
  }

  /// [m] The summed travel of both bodies.
  [[nodiscard]] double travel(int slot, const Motion& motion) const noexcept {
    return body_a(slot, motion).travel + body_b(slot, motion).travel;
  }
  /// False while the pair cannot have come within range by the summed travel of both bodies.
  [[nodiscard]] bool is_due(int slot, const Motion& motion) const noexcept {
    return travel(slot, motion) >= memory_->tracking(slot).due_at;
  }

  /// Sets the summed travel [m] of both bodies before which the pair cannot be near, if later.
  void set_clearance(int slot, const Motion& motion, double clearance) noexcept {
    if (!(clearance > 0.0)) return;
    double& due_at = memory_->tracking(slot).due_at;
    due_at = std::max(due_at, travel(slot, motion) + clearance);
  }

  /// Lower bound of the signed distance [m] now, from the last answer.
  [[nodiscard]] double lower_bound(int slot, const Motion& motion) const noexcept {
    const PairAnswer& answer = memory_->answer(slot);
    const double now = answer.lower_bound(body_a(slot, motion), body_b(slot, motion));
    return now > 0.0 ? now : std::max(now, -world_->deepest(pair(slot)));
  }

  /// [m] The part of the reduction of that bound that is due to rotation of the bodies.
  [[nodiscard]] double lost_to_rotation(int slot, const Motion& motion) const noexcept {
    return body_a(slot, motion).turn + body_b(slot, motion).turn - memory_->answer(slot).turn;
  }

  /// Another lower bound [m]: the present distance of the shapes along the extraction direction of
  /// the last answer. Cost: one evaluation of both support maps.
  [[nodiscard]] double lower_bound_by_shapes(int slot, const Motion& motion,
                                             PartPoses& poses) const noexcept {
    const PosedShape A = posed(pair(slot).a, motion, poses), B = posed(pair(slot).b, motion, poses);
    return -overlap_along(memory_->answer(slot).last.extraction_W, A, B) - rounding;
  }

  /// Time to contact [s] at the present velocities, negative in overlap, 1e9 for separating pairs.
  [[nodiscard]] double time_to_touch(int slot, const Motion& motion) const noexcept {
    const double closing = -dot(memory_->answer(slot).last.extraction_W, velocity(slot, motion));
    const double distance = lower_bound(slot, motion);
    return closing > 0.0 || distance < 0.0 ? distance / std::max(closing, 1e-3) : 1e9;
  }

  /// Removes the pair, which is out of reach, from its list.
  void remove_from_list(int slot) noexcept {
    memory_->answer(slot).in_range = false;
    memory_->remove_from_list(slot);
  }

  /// Stores an answer, from which a force was computed at the last tick.
  void store(int slot, const PairAnswer& answer) noexcept {
    memory_->answer(slot) = answer;
    memory_->answer(slot).pushed_at = now_ - 1;
  }

  /// The pair was evaluated since `begin_tick`.
  [[nodiscard]] bool is_fresh(int slot) const noexcept {
    return memory_->answer(slot).evaluated_at == now_;
  }

  /// For a pair that comes within range: discards its warm start, so that its forces depend only on
  /// its motion within range.
  void clear_history(int slot) noexcept { memory_->history(slot) = {}; }

  /// Evaluates the pair of a slot. Different threads may evaluate different pairs at the same time,
  /// with `poses` and `totals` of their own.
  void evaluate(int slot, const Motion& motion, PartPoses& poses, PairTotals& totals) noexcept {
    PairAnswer& answer = memory_->answer(slot);
    note_assumed(slot, motion);
    const WarmStart& warm = memory_->history(slot).warm;
    const bool is_warm = warm.size > 0 || warm.level_a > 0;
    answer.last = query(slot, motion, poses);
    ++totals.evaluated;
    totals.iterations += answer.last.iterations;
    if (is_warm && !answer.in_range && answer.last.lower <= pair(slot).law.range + rounding) {
      clear_history(slot);
      answer.last = query(slot, motion, poses);
      totals.iterations += answer.last.iterations;
    }
    complete(slot, motion, poses, totals);
  }
  /// Repeats the query of the last tick to warm the CPU caches, without other effects.
  void rehearse(int slot, const PartPoses& poses) const noexcept {
    WarmStart warm = memory_->history(slot).warm;
    const Pair& p = pair(slot);
    (void)separation(world_->part(p.a).shape, poses.last(p.a), world_->part(p.b).shape,
                     poses.last(p.b), world_->query_options(), warm);
  }

  /// Adds the force of the pair on both bodies, at its distance if fresh, else at its lower bound.
  void push(int slot, const Motion& motion) noexcept {
    PairAnswer& answer = memory_->answer(slot);
    answer.is_stale = answer.evaluated_at != now_;
    // The time out of reach does not count as waiting for an evaluation.
    if (answer.pushed_at != now_ - 1) answer.waits_since = motion.tick - 1;
    answer.pushed_at = now_;
    if (!answer.is_stale) {
      answer.waits_since = motion.tick;
      return push_at(answer.proven(), 1.0, slot, motion);
    }
    const std::int64_t age = motion.tick - answer.waits_since;
    PairTotals& totals = forces_->totals;
    ++totals.stale;
    totals.oldest_age = std::max(totals.oldest_age, age);
    totals.expired += age > max_age_ ? 1 : 0;
    push_at(lower_bound(slot, motion), share_of_stale(age, max_age_), slot, motion);
  }

  /// The pair for a display; none if at the tick of `motion` it was neither evaluated, nor pushed,
  /// nor watched.
  [[nodiscard]] std::optional<NearPair> near_pair(int slot, const Motion& motion) const noexcept {
    const PairAnswer& answer = memory_->answer(slot);
    const bool stale = answer.tick != motion.tick;
    const bool is_waiting = stale && answer.pushed_at != now_;
    if (is_waiting && !answer.is_watched) return std::nullopt;
    return NearPair{.pair = memory_->tracking(slot).pair,
                    .separation = answer.last,
                    .force = answer.force,
                    .stale = stale,
                    .age = stale ? answer.age(motion.tick) : 0,
                    .has_patch = answer.nearer != 0.0,
                    .is_watched = is_waiting};
  }

  /// Call before a stale pair is evaluated: notes the bound that its force would come from.
  void note_assumed(int slot, const Motion& motion) noexcept {
    PairAnswer& answer = memory_->answer(slot);
    if (answer.is_stale) answer.assumed = lower_bound(slot, motion);
  }
  /// Call after that evaluation: adds to `PairTotals::refresh_energy`.
  /// @param distance [m] the distance found
  void add_refresh_energy(int slot, double distance, PairTotals& totals) const noexcept {
    const ForceLaw& law = pair(slot).law;
    const double assumed = memory_->answer(slot).assumed;
    totals.refresh_energy += std::max(0.0, law.potential(assumed) - law.potential(distance));
  }

 private:
  /// [m] Exceeds the difference between any two answers to the same query.
  static constexpr double rounding = 1e-9;
  /// A watched pair is evaluated again when its bodies have moved by this share of its distance to
  /// where it is near: its direction hardly turns before.
  static constexpr double share_of_watch = 0.2;

  [[nodiscard]] PosedShape posed(PartId part, const Motion& motion,
                                 PartPoses& poses) const noexcept {
    return {world_->part(part).shape, poses.at(part, motion)};
  }

  [[nodiscard]] Separation query(int slot, const Motion& motion, PartPoses& poses) noexcept {
    const auto [a, X_WA] = posed(pair(slot).a, motion, poses);
    const auto [b, X_WB] = posed(pair(slot).b, motion, poses);
    return separation(a, X_WA, b, X_WB, world_->query_options(), memory_->history(slot).warm);
  }

  /// Fills in the rest of the answer after a new query and updates the totals.
  void complete(int slot, const Motion& motion, PartPoses& poses, PairTotals& totals) noexcept {
    const Pair& p = pair(slot);
    PairAnswer& answer = memory_->answer(slot);
    if (p.law.passable) {
      int iterations = 0;
      answer.slope = slope_of(answer.last, posed(p.a, motion, poses), posed(p.b, motion, poses),
                              world_->query_options(), memory_->history(slot).warm, iterations);
      totals.iterations += iterations;
    } else if (answer.is_stale) {
      add_refresh_energy(slot, answer.proven(), totals);
    }
    const auto relative = relative_motion(body_a(slot, motion), body_b(slot, motion));
    answer.p_AQ_W = answer.last.p_WA - to_vec3(relative.p_WoA);
    answer.p_BA_W = to_vec3(relative.p_BA_W);
    answer.turn = relative.turn;
    answer.tick = motion.tick;
    answer.evaluated_at = now_;
    answer.in_range = answer.last.lower < p.law.range;
    const double out_of_reach = answer.last.lower - reach(slot);
    const double out_of_range = out_of_reach + p.law.watched;
    answer.is_watched = out_of_reach < 0.0 && out_of_range > 0.0;
    set_clearance(slot, motion, answer.is_watched ? share_of_watch * out_of_range : out_of_reach);
    find_gradient(slot, motion, poses);
    const PairId id = memory_->tracking(slot).pair;
    const double deepest = std::max(0.0, -answer.last.lower);
    totals.deepest = std::max(totals.deepest, deepest);
    memory_->extremes(id).add({.nearest = answer.last.distance, .deepest = deepest});
    if (answer.last.distance < totals.nearest) {
      totals.nearest = answer.last.distance;
      totals.nearest_pair = id;
    }
  }

  /// The contact patch of a new answer, or its nearest point.
  void find_gradient(int slot, const Motion& motion, PartPoses& poses) noexcept {
    const Pair& p = pair(slot);
    PairAnswer& answer = memory_->answer(slot);
    ContactPatch patch{.gradient = {answer.last.extraction_W}};
    if (answer.in_range && p.law.tilt > 0.0) {
      (void)memory_->history(slot).pointed.find_patch(answer.last, posed(p.a, motion, poses),
                                                      posed(p.b, motion, poses), p.law.tilt, patch);
    }
    answer.nearer = patch.nearer;
    answer.gradient = patch.gradient;
    answer.gradient.torque += answer.p_AQ_W.cross(patch.gradient.force);
  }

  /// Velocity of A relative to B [m/s] at the witness point of the last answer.
  [[nodiscard]] Vec3 velocity(int slot, const Motion& motion) const noexcept {
    const auto relative = relative_motion(body_a(slot, motion), body_b(slot, motion));
    return to_vec3(relative.v_BA_W) + to_vec3(relative.w_BA_W).cross(memory_->answer(slot).p_AQ_W);
  }

  /// Adds the force of the pair at that distance [m], scaled by `share`.
  void push_at(double distance, double share, int slot, const Motion& motion) noexcept {
    const ForceLaw& law = pair(slot).law;
    memory_->answer(slot).force = 0.0;
    if (!(distance < law.range)) return;
    const PairAnswer& answer = memory_->answer(slot);
    const BodyState& A = body_a(slot, motion);
    const BodyState& B = body_b(slot, motion);
    const PairTracking& tracking = memory_->tracking(slot);
    if (tracking.is_loose) {
      const Share acts = share_between(A, B);
      const double gained = law.passable ? 0.0 : share * (acts.now - acts.before);
      forces_->supply(tracking.body_a, tracking.body_b, gained * law.potential(distance), motion);
      share *= acts.now;
    }
    double size = 0.0;
    Wrench on_a;
    if (law.passable) {
      const Vec3 f = share * memory_->history(slot).passage.force(
                                 law, distance, answer.slope * answer.last.extraction_W,
                                 A.travel + B.travel, velocity(slot, motion));
      size = norm(f);
      on_a = wrench_of_force(f, answer.p_AQ_W);
      if (size > 0.0) memory_->answer(slot).gradient = 1.0 / size * on_a;
    } else {
      const auto relative = relative_motion(A, B);
      const Wrench& g = answer.gradient;
      size = share * force_of(law.formula(), distance, Vec<double>(g.force), Vec<double>(g.torque),
                              relative);
      on_a = size * g;
    }
    memory_->answer(slot).force = size;
    forces_->totals.note_force(size, tracking.pair);
    double& peak = memory_->extremes(tracking.pair).peak_force;
    peak = std::max(peak, size);
    const Vec3 p_BA_W = origin(A.X_WB) - origin(B.X_WB);
    forces_->push(tracking.body_a, tracking.body_b, on_a,
                  {-on_a.force, -on_a.torque - p_BA_W.cross(on_a.force)}, motion);
  }

  const World* world_;
  PairMemory* memory_;
  PairForces* forces_;
  std::int64_t max_age_;  ///< [ticks]
  /// Counts the exchanges begun. It is not `Motion::tick`: two exchanges may be of one motion, and
  /// ticks may pass between them.
  std::int64_t now_ = 0;
};

}  // namespace repel::detail
