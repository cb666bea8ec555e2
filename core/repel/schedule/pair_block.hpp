/// @file
/// A block of pairs: selects the near pairs, schedules their evaluation, and sums their forces.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <repel/pairs/candidates.hpp>
#include <repel/pairs/lane_evaluator.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/schedule/evaluation_order.hpp>

namespace repel::detail {

/// A subset of the world's pairs. Those that can soon come within range are its candidates; each
/// has a slot of memory, which it keeps until another needs it. All memory is allocated at
/// construction.
class PairBlock {
 public:
  /// @param slots largest number of pairs with a slot, at least 0
  PairBlock(const World& world, PairPartition partition, int slots, const Budget& budget = {})
      : singles_(world, partition, slots, budget.max_age),
        lanes_(singles_),
        candidates_(memory().slots()),
        near_singles_(memory().slots()),
        order_(memory().slots()) {}
  // lanes_ keeps a pointer to singles_.
  PairBlock(const PairBlock&) = delete;
  PairBlock& operator=(const PairBlock&) = delete;

  /// Evaluates every pair once, so that each has an answer at the first tick; clears the forces.
  void prime(const Motion& motion, PartPoses& poses) noexcept {
    for (int position = 0; position < memory().pairs(); ++position) {
      const PairId id = memory().partition().pair_at(position);
      singles_.evaluate(memory().slot_for(id), motion, poses);
    }
    singles_.forces().clear();
  }

  /// Makes every pair a permanent candidate, and every candidate near. Requires a slot for each.
  void track_all() noexcept {
    all_near_ = true;
    for (int position = 0; position < memory().pairs(); ++position) {
      const PairId id = memory().partition().pair_at(position);
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
    singles_.set_clearance(slot, motion, distance - singles_.pair(slot).law.range);
    if (memory().is_temporary(slot)) {
      PairTotals& totals = singles_.forces().totals;
      ++totals.crowded;
      if (singles_.is_due(slot, motion)) {
        ++totals.near;
        singles_.evaluate(slot, motion, poses);
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

  /// Evaluates the near candidates until `work_units` are spent or `deadline` is reached, and
  /// computes the forces of all. If the last tick could not evaluate all, half the number it
  /// managed is selected by urgency; the others follow round-robin from where it stopped, so that
  /// no pair starves. An evaluation is never cut short: half of one would cost most of a whole one
  /// and might give a weaker bound than the old answer. A pair without any answer is evaluated in
  /// any case.
  void run(const Motion& motion, PartPoses& poses, std::int64_t work_units,
           std::chrono::steady_clock::time_point deadline) noexcept {
    const bool counted = work_units < std::numeric_limits<std::int64_t>::max();
    // Pairs in lanes are evaluated several at a time: too coarse for a budget in work units.
    if (counted) lanes_.remove_all(poses);
    find_near_singles(motion, poses);
    evaluate(motion, poses, work_units, deadline);
    // Summed in an order that does not depend on the order of evaluation.
    lanes_.push(motion);
    for (int k = 0; k < single_count_; ++k) singles_.push(near_singles_[k], motion);
    lanes_.remove_ended(poses);
    for (int k = 0; !counted && k < single_count_; ++k) lanes_.add(near_singles_[k], poses);
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

  [[nodiscard]] const PairForces& forces() const noexcept { return singles_.forces(); }
  /// The last stored answer; the default one, which bounds nothing, if there is none.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const int slot = memory().slot_of(id);
    return slot == PairMemory::none ? Separation{} : lanes_.separation_of(slot);
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    return lanes_.extremes_of(id);
  }
  /// Calls see(NearPair) for each pair that was near at `run` with the same motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const auto near = lanes_.near_pair(candidate.slot, motion);
      if (near) see(*near);
    }
  }
  [[nodiscard]] const PairMemory& memory() const noexcept { return singles_.memory(); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] PairMemory& memory() noexcept { return singles_.memory(); }

  [[nodiscard]] static bool is_over(Clock::time_point deadline) noexcept {
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
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
    const double range = singles_.pair(slot).law.range;
    double clearance = singles_.lower_bound(slot, motion) - range;
    if (!(clearance > 0.0) && clearance + singles_.lost_to_rotation(slot, motion) > 0.0) {
      clearance = singles_.lower_bound_by_shapes(slot, motion, poses) - range;
    }
    singles_.set_clearance(slot, motion, clearance);
    if (clearance > 0.0) return false;
    singles_.clear_history(slot);
    return true;
  }

  /// Evaluates the pairs in lanes and the single pairs. When time does not suffice for all, the two
  /// kinds alternate in going first.
  void evaluate(const Motion& motion, PartPoses& poses, std::int64_t work_units,
                Clock::time_point deadline) noexcept {
    const int before = singles_.forces().totals.evaluated;
    spent_ = false;
    if (singles_first_) evaluate_singles(motion, poses, work_units, deadline);
    evaluate_groups(motion, poses, deadline);
    if (!singles_first_) evaluate_singles(motion, poses, work_units, deadline);
    // A turn in which nothing could be evaluated does not count.
    if (!spent_)
      singles_first_ = false;
    else if (singles_.forces().totals.evaluated > before)
      singles_first_ = !singles_first_;
  }

  void evaluate_groups(const Motion& motion, PartPoses& poses,
                       Clock::time_point deadline) noexcept {
    const int groups = lanes_.groups();
    if (next_group_ >= groups) next_group_ = 0;
    for (int k = 0; k < groups; ++k) {
      const int g = next_group_ + k < groups ? next_group_ + k : next_group_ + k - groups;
      if (spent_ || is_over(deadline)) {
        spent_ = true;
        next_group_ = g;
        return;
      }
      lanes_.evaluate_group(g, motion, poses);
    }
  }

  void evaluate_singles(const Motion& motion, PartPoses& poses, std::int64_t work_units,
                        Clock::time_point deadline) noexcept {
    const PairTotals& totals = singles_.forces().totals;
    const auto order = in_order(motion);
    int evaluated = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int slot = near_singles_[order[k]];
      if (!spent_ && (totals.iterations >= work_units || is_over(deadline))) {
        spent_ = true;
        if (k >= static_cast<std::size_t>(urgent_)) next_ = memory().tracking(slot).pair;
      }
      if (spent_ && memory().answer(slot).known()) continue;
      ++evaluated;
      singles_.evaluate(slot, motion, poses);
    }
    urgent_ = spent_ ? evaluated / 2 : 0;
  }

  /// Evaluation order of the near single pairs, as indices into `near_singles_`; the most urgent
  /// first if there was not enough time at the last tick.
  [[nodiscard]] std::span<const std::int32_t> in_order(const Motion& motion) noexcept {
    urgent_ = std::min(urgent_, single_count_);
    const auto begin = near_singles_.begin();
    const auto first = std::lower_bound(
        begin, begin + single_count_, next_.index,
        [&](std::int32_t slot, std::int32_t i) { return memory().tracking(slot).pair.index < i; });
    return order_.arrange(
        single_count_, static_cast<int>(first - begin), urgent_,
        [&](std::int32_t k) { return singles_.time_to_touch(near_singles_[k], motion); });
  }

  SingleEvaluator singles_;
  LaneEvaluator lanes_;
  Candidates candidates_;
  bool all_near_ = false;
  std::vector<std::int32_t> near_singles_;  ///< slots of the near pairs that are in no lane
  int single_count_ = 0;                    ///< number of valid entries in `near_singles_`
  EvaluationOrder order_;
  bool spent_ = false;  ///< the budget of this tick is exhausted
  bool singles_first_ = false;
  PairId next_{0};      ///< round-robin start of the single pairs
  int next_group_ = 0;  ///< round-robin start of the groups
  int urgent_ = 0;      ///< number of single pairs selected by urgency
};

}  // namespace repel::detail
