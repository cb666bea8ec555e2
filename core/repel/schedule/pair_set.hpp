/// @file
/// The pairs of a world: selects the near ones, divides their evaluation into batches that several
/// threads can share, and sums their forces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <repel/pairs/candidates.hpp>
#include <repel/pairs/lane_evaluator.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/schedule/evaluation_plan.hpp>

namespace repel::detail {

/// All pairs of a world. Those that can soon come within range are its candidates; each has a slot
/// of memory, which it keeps until another needs it. A tick is `begin_tick`, the search, which
/// calls `take` and `end`, then `select`, `evaluate` for each batch, and `finish`. Only `evaluate`
/// may be called by several threads, each batch once; whichever thread does it, the forces have the
/// same bits. All memory is allocated at construction.
class PairSet {
 public:
  /// @param slots largest number of pairs with a slot, at least 0
  /// @param lookahead [m] by which a pair may be out of its range and yet be near
  PairSet(const World& world, int slots, const Budget& budget = {}, double lookahead = 0.0)
      : singles_(world, slots, budget.max_age, lookahead),
        lanes_(singles_),
        candidates_(memory().slots()),
        near_singles_(memory().slots()),
        plan_(memory().slots() / lane_count + 1, memory().slots()) {}
  // lanes_ keeps a pointer to singles_.
  PairSet(const PairSet&) = delete;
  PairSet& operator=(const PairSet&) = delete;

  /// Evaluates every pair once, so that each has an answer at the first tick; clears the forces.
  void prime(const Motion& motion, PartPoses& poses) noexcept {
    for (PairId id{0}; id.index < memory().pairs(); ++id.index) {
      singles_.evaluate(memory().slot_for(id), motion, poses, singles_.forces().totals);
    }
    singles_.forces().clear();
  }

  /// Makes every pair a permanent candidate, and every candidate near. Requires a slot for each.
  void track_all() noexcept {
    all_near_ = true;
    for (PairId id{0}; id.index < memory().pairs(); ++id.index) {
      candidates_.add(id, memory().slot_for(id));
    }
    candidates_.sort();
  }

  /// Begins a tick: clears the forces.
  void begin_tick(std::int64_t tick) noexcept {
    singles_.begin_tick(tick);
    lanes_.begin_tick();
  }

  /// Makes a pair a candidate. Returns false if there is no slot for it: it is then evaluated at
  /// once, without a warm start, if it can be near.
  /// @param list the search list in which it was found
  /// @param distance [m] lower bound of the true distance
  bool take(PairId id, std::int32_t list, double distance, const Motion& motion,
            PartPoses& poses) noexcept {
    const int slot = memory().slot_for(id);
    singles_.set_clearance(slot, motion, distance - singles_.reach(slot));
    if (memory().is_temporary(slot)) {
      PairTotals& totals = singles_.forces().totals;
      ++totals.crowded;
      if (singles_.is_due(slot, motion)) {
        ++totals.near;
        singles_.evaluate(slot, motion, poses, totals);
        singles_.push(slot, motion);
      }
      return false;
    }
    memory().tracking(slot).found = true;
    if (memory().add_to_list(slot, list)) candidates_.add(id, slot);
    return true;
  }

  /// Ends a search of a list: removes those of its candidates that were not taken, except pairs in
  /// lanes. These leave only when their evaluation finds them out of range, so that their forces do
  /// not depend on the search. Returns how many of these were kept.
  int end(std::int32_t list) noexcept {
    int kept = 0;
    candidates_.remove_if([&](std::int32_t slot) {
      PairTracking& tracking = memory().tracking(slot);
      const bool missing = tracking.list == list && !tracking.found;
      const bool leaves = missing && tracking.lane < 0;
      kept += missing && !leaves ? 1 : 0;
      if (leaves) singles_.remove_from_list(slot);
      tracking.found = false;
      return leaves;
    });
    candidates_.sort();
    return kept;
  }

  /// Selects the near candidates and divides them into batches (EvaluationPlan). Returns the number
  /// of these.
  int select(const Motion& motion, PartPoses& poses, const EvaluationLimit& limit) noexcept {
    // Pairs in lanes are evaluated several at a time: too coarse for a budget in work units.
    if (limit.is_counted()) lanes_.remove_all(poses);
    find_near_singles(motion, poses);
    return plan_.plan(
        limit, lanes_.groups(), single_count_, [&](int k) { return pair_of_single(k); },
        [&](std::int32_t k) { return singles_.time_to_touch(near_singles_[k], motion); });
  }

  /// Evaluates a batch until the limit of the tick is reached. An evaluation is never cut short:
  /// half of one would cost most of a whole one and might give a weaker bound than the old answer.
  /// A pair without any answer is evaluated in any case.
  /// @param spent support-map pairs before it @return how many it took
  std::int64_t evaluate(int batch, const Motion& motion, PartPoses& poses,
                        std::int64_t spent = 0) noexcept {
    return plan_.run(
        batch, spent,
        [&](int g, PairTotals& totals) { lanes_.evaluate_group(g, motion, poses, totals); },
        [&](int k, bool allowed, PairTotals& totals) {
          const std::int32_t slot = near_singles_[k];
          if (!allowed && memory().answer(slot).known()) return;
          singles_.evaluate(slot, motion, poses, totals);
        });
  }

  /// Evaluates all batches in this thread.
  void evaluate_all(const Motion& motion, PartPoses& poses) noexcept {
    std::int64_t spent = singles_.forces().totals.iterations;
    for (int k = 0; k < plan_.batches(); ++k) spent += evaluate(k, motion, poses, spent);
  }

  /// Computes and sums the forces of all near pairs, in an order that does not depend on that of
  /// their evaluation.
  void finish(const Motion& motion, const PartPoses& poses) noexcept {
    plan_.finish(singles_.forces().totals, [&](int k) { return pair_of_single(k); });
    lanes_.push(motion);
    for (int k = 0; k < single_count_; ++k) singles_.push(near_singles_[k], motion);
    lanes_.remove_ended(poses);
    if (plan_.limit().is_counted()) return;
    for (int k = 0; k < single_count_; ++k) lanes_.add(near_singles_[k], poses);
  }

  /// Ticks have passed without this set: what waited for an evaluation does so no more.
  void skip_ticks() noexcept { begin_tick(forces().tick); }

  /// Drops all candidates, as if they were out of reach. The search must find them all again.
  void forget(const PartPoses& poses) noexcept {
    skip_ticks();
    if (all_near_) return;
    lanes_.remove_all(poses);
    candidates_.remove_if([&](std::int32_t slot) {
      singles_.remove_from_list(slot);
      return true;
    });
  }

  /// Repeats the work of the last tick on up to `most` near pairs to warm the CPU caches, without
  /// other effects. Returns the number of pairs.
  int rehearse(const Motion& motion, PartPoses& poses, int most) noexcept {
    int done = lanes_.rehearse(most, motion, poses);
    for (int k = 0; k < single_count_ && done < most; ++k, ++done) {
      singles_.rehearse(near_singles_[k], poses);
    }
    return done;
  }

  /// Near pairs of this tick. After `select`.
  [[nodiscard]] int near() const noexcept { return lanes_.count() + single_count_; }
  [[nodiscard]] const PairForces& forces() const noexcept { return singles_.forces(); }
  /// The last stored answer; the default one, which bounds nothing, if there is none.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const int slot = memory().slot_of(id);
    return slot == PairMemory::none ? Separation{} : lanes_.separation_of(slot);
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    return lanes_.extremes_of(id);
  }
  /// Calls see(NearPair) for each pair that was near at the tick of that motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const auto near = lanes_.near_pair(candidate.slot, motion);
      if (near) see(*near);
    }
  }
  /// Calls see(NearPair, NearAnswer) for each of these.
  template <class See>
  void for_each_answer(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const auto near = lanes_.near_pair(candidate.slot, motion);
      if (near) see(*near, lanes_.near_answer(candidate.slot, motion));
    }
  }
  [[nodiscard]] const PairMemory& memory() const noexcept { return singles_.memory(); }

 private:
  [[nodiscard]] PairMemory& memory() noexcept { return singles_.memory(); }

  /// The index of the pair of the k-th near single.
  [[nodiscard]] std::int32_t pair_of_single(int k) const noexcept {
    return memory().tracking(near_singles_[k]).pair.index;
  }

  void find_near_singles(const Motion& motion, PartPoses& poses) noexcept {
    single_count_ = 0;
    // Every pair in a lane is a candidate: if there are no other candidates, skip the scan.
    if (candidates_.all().size() > static_cast<std::size_t>(lanes_.count()))
      look_for_near_singles(motion, poses);
    singles_.forces().totals.near += lanes_.count() + single_count_;
  }

  void look_for_near_singles(const Motion& motion, PartPoses& poses) noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const std::int32_t slot = candidate.slot;
      if (memory().tracking(slot).lane >= 0) continue;
      if (all_near_ || is_near(slot, motion, poses)) near_singles_[single_count_++] = slot;
    }
  }

  /// False if the pair is proven to be out of range. Tests, cheapest first: the travel of the
  /// bodies; the last separating plane shifted by their motion; and, if the rotation term alone
  /// spoils that bound, the present distance of the shapes along the last direction.
  [[nodiscard]] bool is_near(int slot, const Motion& motion, PartPoses& poses) noexcept {
    if (!singles_.is_due(slot, motion)) return false;
    if (memory().answer(slot).in_range) return true;
    const double reach = singles_.reach(slot);
    double clearance = singles_.lower_bound(slot, motion) - reach;
    if (!(clearance > 0.0) && clearance + singles_.lost_to_rotation(slot, motion) > 0.0) {
      clearance = singles_.lower_bound_by_shapes(slot, motion, poses) - reach;
    }
    singles_.set_clearance(slot, motion, clearance);
    if (clearance > 0.0) return false;
    singles_.clear_history(slot);
    return true;
  }

  SingleEvaluator singles_;
  LaneEvaluator lanes_;
  Candidates candidates_;
  bool all_near_ = false;
  std::vector<std::int32_t> near_singles_;  ///< slots of the near pairs that are in no lane
  int single_count_ = 0;                    ///< number of valid entries in `near_singles_`
  EvaluationPlan plan_;
};

}  // namespace repel::detail
