// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIMD evaluation of those pairs of a world in range whose nearest features are known.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <repel/pairs/lane_sum.hpp>
#include <repel/pairs/near_answer.hpp>
#include <repel/pairs/single_evaluator.hpp>

namespace repel::detail {

/// Holds some of the pairs of a PairMemory in groups of SIMD lanes; lanes are numbered
/// consecutively across groups. Pairs of boxes come first: a group costs as much as the polygon
/// with most sides in it. There are no gaps: when a pair is removed, the last one takes its lane.
/// The answer of a pair stays in its lane until the pair is moved or removed or its group is not
/// evaluated at a tick; then it is stored in the memory. All memory is allocated at construction.
class LaneEvaluator {
 public:
  /// @param singles evaluates the pairs that are in no lane
  /// @param memory,forces those of `singles`; must outlive this object, as it must
  LaneEvaluator(SingleEvaluator& singles, PairMemory& memory, PairForces& forces)
      : singles_(&singles),
        memory_(&memory),
        forces_(&forces),
        groups_((lanes_for(memory.slots()) + lane_count - 1) / lane_count),
        slots_(groups_.size() * lane_count) {}

  /// Pairs in lanes.
  [[nodiscard]] int count() const noexcept { return count_; }
  /// Groups with at least one pair.
  [[nodiscard]] int groups() const noexcept { return (count_ + lane_count - 1) / lane_count; }
  [[nodiscard]] const LaneGroup& group(int g) const noexcept { return groups_[g]; }
  /// The slot of the pair in a lane.
  [[nodiscard]] std::int32_t slot(int lane) const noexcept { return slots_[lane]; }

  /// Begins a tick: marks all answers as not of this tick.
  void begin_tick() noexcept {
    for (int g = 0; g < groups(); ++g) groups_[g].begin_tick();
  }

  /// The last stored answer of a pair, in a lane or not.
  [[nodiscard]] Separation separation_of(int slot) const noexcept {
    const int lane = lane_of(slot);
    if (!has_answer(lane)) return memory_->answer(slot).last;
    return group_of(lane).answer(index_of(lane)).last;
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    PairExtremes extremes = memory_->extremes(id);
    const int slot = memory_->slot_of(id);
    const int lane = slot == PairMemory::none ? -1 : lane_of(slot);
    if (lane >= 0) extremes.add(extremes_in(lane));
    return extremes;
  }
  /// The pair at the tick of `motion`, if it was near then. Call after `remove_ended`.
  [[nodiscard]] std::optional<NearPair> near_pair(int slot, const Motion& motion) const noexcept {
    const int lane = lane_of(slot);
    if (!has_answer(lane)) return singles_->near_pair(slot, motion);
    const LaneGroup& group = group_of(lane);
    const int k = index_of(lane);
    const PairAnswer answer = group.answer(k);
    return NearPair{memory_->tracking(slot).pair, answer.last, group.force(k), false, 0,
                    answer.nearer != 0.0};
  }

  /// What another thread needs to know of a pair for which `near_pair` is one.
  [[nodiscard]] NearAnswer near_answer(int slot, const Motion& motion) const noexcept {
    const int lane = lane_of(slot);
    const PairAnswer answer =
        has_answer(lane) ? group_of(lane).answer(index_of(lane)) : memory_->answer(slot);
    const PairTracking& tracking = memory_->tracking(slot);
    const bool stale = answer.tick != motion.tick;
    const bool passable = singles_->pair(slot).law.passable;
    return {.gradient = passable ? answer.force * answer.gradient : answer.gradient,
            .bound = stale ? singles_->lower_bound(slot, motion) : answer.proven(),
            .share = stale ? share_of_stale(answer.age(motion.tick), singles_->max_age()) : 1.0,
            .pair = tracking.pair,
            .a = tracking.body_a,
            .b = tracking.body_b,
            .is_apart = answer.is_apart(),
            .has_patch = answer.nearer != 0.0,
            .is_passable = passable};
  }

  /// The pair was evaluated at this tick and can be evaluated in a lane.
  [[nodiscard]] bool may_add(int slot) const noexcept {
    return singles_->is_fresh(slot) && fits(slot);
  }
  /// How many of `wanted` pairs to add, or, negative, to remove: there may be no lanes for all, and
  /// a group of few pairs costs more than these do singly.
  [[nodiscard]] int to_add(int wanted) const noexcept {
    const int more = std::min(wanted, static_cast<int>(slots_.size()) - count_);
    const int last = (count_ + more) % lane_count;
    // Once they are there, one less may stay, so that a pair that comes and goes moves no others.
    const int fewest = more > 0 ? fewest_in_group : fewest_in_group - 1;
    return last < fewest ? more - last : more;
  }
  /// Puts a pair into a lane for which `may_add` is true.
  void add(int slot, const PartPoses& poses) noexcept {
    int lane = count_;
    if (are_boxes(slot)) {
      lane = boxes_++;
      move(lane, count_, poses);
    }
    put(lane, slot, poses);
    ++count_;
  }

  /// Removes the pair from its lane, if it has one.
  void remove(int slot, const PartPoses& poses) noexcept {
    int lane = lane_of(slot);
    if (lane < 0) return;
    take_out(slot);
    if (lane < boxes_) {
      move(--boxes_, lane, poses);
      lane = boxes_;
    }
    move(--count_, lane, poses);
    groups_[count_ / lane_count].remove(index_of(count_));
  }

  /// Removes the last pairs, as many as that.
  void remove_last(int pairs, const PartPoses& poses) noexcept {
    for (int i = 0; i < pairs; ++i) remove(slots_[count_ - 1], poses);
  }
  void remove_all(const PartPoses& poses) noexcept { remove_last(count_, poses); }

  /// Evaluates the pairs of a group; falls back to single evaluation where the nearest feature has
  /// changed. Different groups may be evaluated by different threads at the same time, each with
  /// `poses` and `totals` of its own.
  void evaluate_group(int g, const Motion& motion, PartPoses& poses, PairTotals& totals) noexcept {
    LaneGroup& group = groups_[g];
    const unsigned stale = group.stale();
    for_each(stale, [&](int k) { singles_->note_assumed(slot_at(g, k), motion); });
    group.evaluate(motion, poses);
    const int answered = std::popcount(group.proven());
    totals.evaluated += answered;
    totals.iterations += answered;
    const unsigned unproven = group.used() & ~group.proven();
    if ((stale | unproven) == 0U) return;
    for_each(stale & group.proven(), [&](int k) {
      singles_->add_refresh_energy(slot_at(g, k), group.answer(k).proven(), totals);
      memory_->answer(slot_at(g, k)).is_stale = false;
    });
    for_each(unproven, [&](int k) {
      const int slot = slot_at(g, k);
      memory_->history(slot).pointed = group.pointed(k);
      singles_->evaluate(slot, motion, poses, totals);
      if (fits(slot)) {
        group.set_feature(singles_->world(), k, singles_->pair(slot), memory_->history(slot));
      }
    });
  }

  /// Adds the forces of all pairs in lanes.
  void push(const Motion& motion) noexcept {
    GroupExtremes extremes;
    all_stay_ = true;
    for (int g = 0; g < groups(); ++g) {
      LaneGroup& group = groups_[g];
      if (group.fresh()) {
        extremes.add(group);
        all_stay_ = all_stay_ && group.in_range() == group.used();
        for_each(group.used() & ~group.proven(),
                 [&](int k) { singles_->push(slot_at(g, k), motion); });
        continue;
      }
      for_each(group.used(), [&](int k) {
        store(slot_at(g, k));
        group.set_stale(k);
        singles_->push(slot_at(g, k), motion);
      });
    }
    LaneSum(motion, *forces_).add({groups_.data(), static_cast<std::size_t>(groups())});
    PairTotals& totals = forces_->totals;
    if (extremes.peak_force() > totals.peak_force) note_hardest(extremes.peak_force());
    if (extremes.nearest() < totals.nearest) note_nearest(extremes.nearest());
    totals.deepest = std::max(totals.deepest, extremes.deepest());
  }

  /// Removes from their lanes the pairs that have left their range or whose nearest features are no
  /// longer known. Call after `push`.
  void remove_ended(const PartPoses& poses) noexcept {
    if (all_stay_) return;
    for (int g = groups() - 1; g >= 0; --g) {
      const LaneGroup& group = groups_[g];
      const unsigned staying = group.fresh() ? group.in_range() : group.used();
      if ((group.used() & ~staying) == 0U) continue;
      for (int k = lane_count - 1; k >= 0; --k) {
        if ((group.used() & ~staying & 1U << k) == 0U) continue;
        const bool proven = (group.proven() >> k & 1U) != 0U;
        if (proven || !fits(slot_at(g, k))) remove(slot_at(g, k), poses);
      }
    }
  }

  /// Repeats the last evaluation to warm the CPU caches, without other effects. Returns the number
  /// of pairs evaluated.
  int rehearse(int most, const Motion& motion, PartPoses& poses) noexcept {
    int done = 0;
    for (int g = 0; g < groups() && done < most; ++g) {
      LaneGroup& group = groups_[g];
      if (!group.fresh() || group.proven() != group.used()) continue;
      group.evaluate(motion, poses);
      done += std::min(lane_count, count_ - g * lane_count);
    }
    return done;
  }

 private:
  /// Measured: below, a group costs more than its pairs do singly.
  static constexpr int fewest_in_group = lane_count / 2;

  /// A lane takes more memory than all else that is known of a pair, and where there are thousands
  /// of pairs, few are within range at one time.
  [[nodiscard]] static int lanes_for(int slots) noexcept {
    return std::min(slots, std::max(256, slots / 8));
  }

  [[nodiscard]] int lane_of(int slot) const noexcept { return memory_->tracking(slot).lane; }
  [[nodiscard]] const LaneGroup& group_of(int lane) const noexcept {
    return groups_[lane / lane_count];
  }
  [[nodiscard]] static int index_of(int lane) noexcept { return lane % lane_count; }
  [[nodiscard]] int slot_at(int g, int k) const noexcept { return slots_[g * lane_count + k]; }
  [[nodiscard]] PairId pair_at(int g, int k) const noexcept {
    return memory_->tracking(slot_at(g, k)).pair;
  }
  /// The newest answer of the pair in that lane is in the lane, not in the memory.
  [[nodiscard]] bool has_answer(int lane) const noexcept {
    return lane >= 0 && (group_of(lane).proven() >> index_of(lane) & 1U) != 0U;
  }
  [[nodiscard]] PairExtremes extremes_in(int lane) const noexcept {
    const LaneGroup& group = group_of(lane);
    const int k = index_of(lane);
    return {.nearest = group.nearest(k), .peak_force = group.peak(k), .deepest = group.deepest(k)};
  }
  [[nodiscard]] bool are_boxes(int slot) const noexcept {
    const Pair& p = singles_->pair(slot);
    const auto is_box = [&](PartId part) {
      return singles_->world().part(part).shape.level(0).core.kind() == Convex::Kind::box;
    };
    return is_box(p.a) && is_box(p.b);
  }
  void put(int lane, int slot, const PartPoses& poses) noexcept {
    memory_->tracking(slot).lane = lane;
    slots_[lane] = slot;
    // The unused lanes behind the last one need valid data to compute with, too.
    const int end = lane == count_ ? lane_count : index_of(lane) + 1;
    for (int k = index_of(lane); k < end; ++k) {
      groups_[lane / lane_count].set(singles_->world(), k, singles_->pair(slot),
                                     memory_->history(slot), poses, k == index_of(lane));
    }
  }
  /// Stores what its lane knows of a pair.
  void take_out(int slot) noexcept {
    store(slot);
    const int lane = lane_of(slot);
    memory_->history(slot).pointed = group_of(lane).pointed(index_of(lane));
    memory_->tracking(slot).lane = -1;
  }
  /// Moves the pair of a lane to another one, which has none.
  void move(int from, int to, const PartPoses& poses) noexcept {
    if (from == to) return;
    const int slot = slots_[from];
    take_out(slot);
    put(to, slot, poses);
  }
  /// Calls f(k) for each set bit k.
  template <class F>
  static void for_each(unsigned bits, const F& f) noexcept {
    for (; bits != 0U; bits &= bits - 1U) f(std::countr_zero(bits));
  }

  /// Notes `distance` [m], the least of this tick, and finds the pair it belongs to.
  void note_nearest(double distance) noexcept {
    PairTotals& totals = forces_->totals;
    totals.nearest = distance;
    for (int g = 0; g < groups(); ++g) {
      if (!groups_[g].fresh()) continue;
      for_each(groups_[g].proven(), [&](int k) {
        if (groups_[g].distance(k) == distance) totals.nearest_pair = pair_at(g, k);
      });
    }
  }

  /// Notes `force` [N], the largest of this tick, and finds the pair it belongs to.
  void note_hardest(double force) noexcept {
    for (int g = 0; g < groups(); ++g) {
      if (!groups_[g].fresh()) continue;
      for_each(groups_[g].used(), [&](int k) {
        if (groups_[g].force(k) == force) {
          forces_->totals.note_force(force, pair_at(g, k));
        }
      });
    }
  }

  /// The pair can be evaluated in a lane.
  [[nodiscard]] bool fits(int slot) const noexcept {
    const Pair& p = singles_->pair(slot);
    const World& world = singles_->world();
    return memory_->answer(slot).in_range && !p.law.passable && !memory_->is_temporary(slot) &&
           has_feature(memory_->history(slot).warm) &&
           are_angular(world.part(p.a).shape.level(0), world.part(p.b).shape.level(0));
  }

  /// Copies answer and extremes from the lane of a pair to the memory.
  void store(int slot) noexcept {
    const int lane = lane_of(slot);
    memory_->extremes(memory_->tracking(slot).pair).add(extremes_in(lane));
    if (!has_answer(lane)) return;
    LaneGroup& group = groups_[lane / lane_count];
    singles_->store(slot, group.answer(index_of(lane)));
    group.discard_answer(index_of(lane));
  }

  SingleEvaluator* singles_;
  PairMemory* memory_;
  PairForces* forces_;
  int count_ = 0;
  int boxes_ = 0;  ///< lanes with two boxes, the first ones
  std::vector<LaneGroup> groups_;
  std::vector<std::int32_t> slots_;  ///< by lane
  bool all_stay_ = true;             ///< no pair has to be removed from its lane after this tick
};

}  // namespace repel::detail
