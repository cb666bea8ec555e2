// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pairs of a world: selects the near ones, divides their evaluation into batches that several
/// threads can share, and sums their forces.
#pragma once

#include <cstdint>
#include <vector>

#include <repel/pairs/candidates.hpp>
#include <repel/pairs/lane_evaluator.hpp>
#include <repel/pairs/pair_index.hpp>
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
  PairSet(const World& world, int slots, const Budget& budget = {}, double lookahead = 0.0);
  // lanes_ keeps a pointer to singles_.
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
  [[nodiscard]] const PairForces& forces() const noexcept { return singles_.forces(); }
  /// The last stored answer; the default one, which bounds nothing, if there is none.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept;
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept;
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

  /// The k-th of the due candidates.
  [[nodiscard]] const Candidate& due(int k) const noexcept { return candidates_.all()[due_[k]]; }

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

}  // namespace repel::detail
