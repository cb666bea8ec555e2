// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pairs of a world: selects the near ones, divides their evaluation into batches that several
/// threads can share, and sums their forces.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <repel/pairs/budget.hpp>
#include <repel/pairs/candidates.hpp>
#include <repel/pairs/evaluation_plan.hpp>
#include <repel/pairs/lane_evaluator.hpp>
#include <repel/pairs/pair_index.hpp>

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
  PairSet(const World& world, int slots, const Budget& budget = {}, double lookahead = 0.0);
  // The evaluators point to members.
  PairSet(const PairSet&) = delete;
  PairSet& operator=(const PairSet&) = delete;

  /// Evaluates every pair once that can act, so that it has an answer at the first tick.
  void prime(const Motion& motion, PartPoses& poses) noexcept;

  /// Makes every pair a permanent candidate, and every candidate near. Requires a slot for each.
  void track_all(const PairIndex& index) noexcept;

  /// Begins a tick: clears the forces.
  void begin_tick(std::int64_t tick) noexcept;

  /// Makes a pair a candidate. Returns false if there is no slot for it: it is then evaluated at
  /// once, without a warm start, if it can be near. @param list the search list in which it was
  /// found @param distance [m] lower bound of the true distance
  bool take(PairId id, std::int32_t list, double distance, const Motion& motion,
            PartPoses& poses) noexcept;

  /// Ends a search of a list: removes those of its candidates that were not taken, except pairs in
  /// lanes. These leave only when their evaluation finds them out of range, so that their forces do
  /// not depend on the search. Returns how many of these were kept.
  int end(std::int32_t list) noexcept;

  /// Removes all candidates of a list of parts that can come and go, which are in no lanes.
  void drop(std::int32_t list) noexcept;

  /// Divides the candidates that are due, which may be near, into batches. Returns how many.
  int select(const Motion& motion, PartPoses& poses, const EvaluationLimit& limit) noexcept;

  /// Evaluates a batch until the limit of the tick is reached. An evaluation is never cut short:
  /// half of one would cost most of a whole one and might give a weaker bound than the old answer.
  /// A pair without any answer is evaluated in any case.
  /// @param spent support-map pairs before it @return how many it took
  std::int64_t evaluate(int batch, const Motion& motion, PartPoses& poses,
                        std::int64_t spent = 0) noexcept;

  /// Evaluates all batches in this thread.
  void evaluate_all(const Motion& motion, PartPoses& poses) noexcept;

  /// Computes and sums the forces of all near pairs, in an order independent of their evaluation.
  void finish(const Motion& motion, const PartPoses& poses) noexcept;

  /// Ticks have passed without this set: what waited for an evaluation does so no more.
  void skip_ticks() noexcept { begin_tick(forces().tick); }

  /// Drops all candidates, as if they were out of reach. The search must find them all again.
  void forget(const PartPoses& poses) noexcept;

  /// Repeats the work of the last tick on up to `most` near pairs to warm the CPU caches, without
  /// other effects. Returns the number of pairs.
  int rehearse(const Motion& motion, PartPoses& poses, int most) noexcept;

  /// Pairs that are in lanes or due, most of which are near. After `select`.
  [[nodiscard]] int selected() const noexcept { return lanes_.count() + due_count_; }
  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }
  /// The last stored answer; the default one, which bounds nothing, if there is none.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept;
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept;
  /// Calls see(NearPair) for each pair that was near at the tick of that motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_) {
      const auto near = lanes_.near_pair(candidate.slot, motion);
      if (near) see(*near);
    }
  }
  /// Calls see(NearPair, NearAnswer) for each of these.
  template <class See>
  void for_each_answer(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_) {
      const auto near = lanes_.near_pair(candidate.slot, motion);
      if (near) see(*near, lanes_.near_answer(candidate.slot, motion));
    }
  }
  [[nodiscard]] const PairMemory& memory() const noexcept { return memory_; }

 private:
  /// The k-th of the due candidates.
  [[nodiscard]] const Candidate& due(int k) const noexcept { return candidates_[due_[k]]; }

  /// Calls f(slot) for the due pairs that were found near. After `evaluate`.
  template <class F>
  void for_each_near_single(const F& f) const noexcept {
    for (int k = 0; k < due_count_; ++k) {
      if (is_near_[k] != 0) f(due(k).slot);
    }
  }

  /// In two passes without branches: the first needs the candidates only, the second the tracking
  /// of those that were due by what the candidate knows.
  void find_due(const Motion& motion) noexcept;

  /// False if the pair, which is due, is proven to be out of range, and is then due later. Tests,
  /// cheapest first: the last separating plane shifted by the motion of the bodies; and, if the
  /// rotation term alone spoils that bound, the present distance of the shapes along the last
  /// direction.
  [[nodiscard]] bool is_near(int slot, const Motion& motion, PartPoses& poses) noexcept;

  static constexpr int ahead = 3;  ///< pairs by which answers are fetched before they are read

  PairMemory memory_;
  PairForces forces_;
  SingleEvaluator singles_;
  LaneEvaluator lanes_;
  Candidates candidates_;
  bool all_near_ = false;
  std::vector<std::int32_t> due_;  ///< the candidates in no lane that may be near
  int due_count_ = 0;              ///< number of valid entries in `due_`
  std::vector<char> is_near_;      ///< those of them that are; written by whoever evaluates them
  std::vector<std::int32_t> fitting_;  ///< slots of near pairs that may be put into lanes
  int fitting_count_ = 0;              ///< number of valid entries in `fitting_`
  EvaluationPlan plan_;
};

inline PairSet::PairSet(const World& world, int slots, const Budget& budget, double lookahead)
    : memory_(world, slots, lookahead),
      forces_(world.body_count()),
      singles_(world, memory_, forces_, budget.max_age),
      lanes_(singles_, memory_, forces_),
      candidates_(memory_.slots()),
      due_(memory_.slots()),
      is_near_(memory_.slots()),
      fitting_(memory_.slots()),
      plan_(memory_.slots() / lane_count + 1, memory_.slots()) {}

inline void PairSet::prime(const Motion& motion, PartPoses& poses) noexcept {
  for (PairId id{0}; id.index < memory_.pairs(); ++id.index) {
    if (!acts(singles_.world(), id, motion)) continue;
    singles_.evaluate(memory_.slot_for(id), motion, poses, forces_.totals);
  }
  forces_.clear();
}

inline void PairSet::track_all(const PairIndex& index) noexcept {
  all_near_ = true;
  const auto end = [&](std::size_t list) {
    return list < index.lists.size() ? index.lists[list].first : memory_.pairs();
  };
  for (std::size_t list = 0; list < index.lists.size(); ++list) {
    for (std::int32_t i = index.lists[list].first; i < end(list + 1); ++i) {
      const PairId id = index.pairs[i];
      candidates_.add(id, memory_.slot_for(id), static_cast<std::int32_t>(list));
    }
    candidates_.update(static_cast<std::int32_t>(list), [](std::int32_t) { return false; });
  }
}

inline void PairSet::begin_tick(std::int64_t tick) noexcept {
  singles_.begin_tick(tick);
  lanes_.begin_tick();
}

inline bool PairSet::take(PairId id, std::int32_t list, double distance, const Motion& motion,
                          PartPoses& poses) noexcept {
  const int slot = memory_.slot_for(id);
  const PairTracking& tracking = memory_.tracking(slot);
  if (tracking.is_loose && tracking.list == PairMemory::none) memory_.forget(slot);
  singles_.set_clearance(slot, motion, distance - singles_.reach(slot));
  if (memory_.is_temporary(slot)) {
    PairTotals& totals = forces_.totals;
    ++totals.crowded;
    if (singles_.is_due(slot, motion)) {
      ++totals.near;
      singles_.evaluate(slot, motion, poses, totals);
      singles_.push(slot, motion);
    }
    return false;
  }
  memory_.tracking(slot).found = true;
  if (memory_.add_to_list(slot, list)) candidates_.add(id, slot, list);
  return true;
}

inline int PairSet::end(std::int32_t list) noexcept {
  int kept = 0;
  candidates_.update(list, [&](std::int32_t slot) {
    PairTracking& tracking = memory_.tracking(slot);
    const bool leaves = !tracking.found && tracking.lane < 0;
    kept += !tracking.found && !leaves ? 1 : 0;
    if (leaves) singles_.remove_from_list(slot);
    tracking.found = false;
    return leaves;
  });
  return kept;
}

inline void PairSet::drop(std::int32_t list) noexcept {
  candidates_.update(list, [&](std::int32_t slot) {
    singles_.remove_from_list(slot);
    return true;
  });
}

inline int PairSet::select(const Motion& motion, PartPoses& poses,
                           const EvaluationLimit& limit) noexcept {
  // Pairs in lanes are evaluated several at a time: too coarse for a budget in work units.
  if (limit.is_counted()) lanes_.remove_all(poses);
  find_due(motion);
  forces_.totals.near += lanes_.count();
  return plan_.plan(
      limit, lanes_.groups(), due_count_, [&](int k) { return due(k).key(); },
      [&](std::int32_t k) { return singles_.time_to_touch(due(k).slot, motion); });
}

inline std::int64_t PairSet::evaluate(int batch, const Motion& motion, PartPoses& poses,
                                      std::int64_t spent) noexcept {
  return plan_.run(
      batch, spent,
      [&](int g, PairTotals& totals) { lanes_.evaluate_group(g, motion, poses, totals); },
      [&](int k, bool allowed, PairTotals& totals) {
        const std::int32_t slot = due(k).slot;
        if (k + ahead < due_count_) memory_.prefetch(due(k + ahead).slot);
        is_near_[k] = all_near_ || is_near(slot, motion, poses) ? 1 : 0;
        if (is_near_[k] == 0) return;
        ++totals.near;
        if (!allowed && memory_.answer(slot).known()) return;
        singles_.evaluate(slot, motion, poses, totals);
      });
}

inline void PairSet::evaluate_all(const Motion& motion, PartPoses& poses) noexcept {
  std::int64_t spent = forces_.totals.iterations;
  for (int k = 0; k < plan_.batches(); ++k) spent += evaluate(k, motion, poses, spent);
}

inline void PairSet::finish(const Motion& motion, const PartPoses& poses) noexcept {
  plan_.finish(forces_.totals, [&](int k) { return due(k).key(); });
  lanes_.push(motion);
  for_each_near_single([&](std::int32_t slot) { singles_.push(slot, motion); });
  lanes_.remove_ended(poses);
  if (plan_.limit().is_counted()) return;
  fitting_count_ = 0;
  for_each_near_single([&](std::int32_t slot) {
    if (!memory_.tracking(slot).is_loose && lanes_.may_add(slot)) fitting_[fitting_count_++] = slot;
  });
  const int more = lanes_.to_add(fitting_count_);
  if (more < 0) lanes_.remove_last(-more, poses);
  for (int i = 0; i < more; ++i) lanes_.add(fitting_[i], poses);
}

inline void PairSet::forget(const PartPoses& poses) noexcept {
  skip_ticks();
  if (all_near_) return;
  lanes_.remove_all(poses);
  for (const Candidate& candidate : candidates_) singles_.remove_from_list(candidate.slot);
  candidates_.clear();
}

inline int PairSet::rehearse(const Motion& motion, PartPoses& poses, int most) noexcept {
  int done = lanes_.rehearse(most, motion, poses);
  for_each_near_single([&](std::int32_t slot) {
    if (done < most) singles_.rehearse(slot, poses), ++done;
  });
  return done;
}

inline Separation PairSet::separation_of(PairId id) const noexcept {
  const int slot = memory_.slot_of(id);
  return slot == PairMemory::none ? Separation{} : lanes_.separation_of(slot);
}

inline PairExtremes PairSet::extremes_of(PairId id) const noexcept {
  return lanes_.extremes_of(id);
}

inline void PairSet::find_due(const Motion& motion) noexcept {
  due_count_ = 0;
  Candidate* const all = candidates_.begin();
  // Every pair in a lane is a candidate: if there are no other candidates, skip the scan.
  if (candidates_.count() == lanes_.count()) return;
  std::int32_t list = PairMemory::none;
  double travel = 0.0;
  for (std::int32_t i = 0; i < candidates_.count(); ++i) {
    if (all[i].list != list) {
      list = all[i].list;
      travel = singles_.travel(all[i].slot, motion);
    }
    due_[due_count_] = i;
    due_count_ += travel < all[i].due_at ? 0 : 1;
  }
  const int asked = std::exchange(due_count_, 0);
  for (int k = 0; k < asked; ++k) {
    const std::int32_t i = due_[k];
    const PairTracking& tracking = memory_.tracking(all[i].slot);
    const bool is_due = all_near_ || singles_.is_due(all[i].slot, motion);
    all[i].due_at = is_due ? all[i].due_at : tracking.due_at;
    due_[due_count_] = i;
    due_count_ += tracking.lane < 0 && is_due ? 1 : 0;
  }
}

inline bool PairSet::is_near(int slot, const Motion& motion, PartPoses& poses) noexcept {
  PairAnswer& answer = memory_.answer(slot);
  if (answer.in_range) return true;
  const double reach = singles_.reach(slot);
  double clearance =
      answer.lower_bound(singles_.body_a(slot, motion), singles_.body_b(slot, motion)) - reach;
  if (!(clearance > 0.0) && clearance + singles_.lost_to_rotation(slot, motion) > 0.0) {
    clearance = singles_.lower_bound_by_shapes(slot, motion, poses) - reach;
  }
  singles_.set_clearance(slot, motion, clearance);
  if (clearance > 0.0) {
    answer.is_watched = false;
    return false;
  }
  if (!answer.is_watched) singles_.clear_history(slot);
  return true;
}

}  // namespace repel::detail
