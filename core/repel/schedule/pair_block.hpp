/// @file
/// A share of the pairs that is worked through together: which are due, in which order they are
/// answered, and the forces of all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <repel/schedule/answer_order.hpp>
#include <repel/schedule/candidates.hpp>
#include <repel/schedule/contact_evaluator.hpp>

namespace repel {

/// What may be spent on the pairs of one tick. A pair that could not be answered keeps its last
/// answer, widened by what has moved since.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick, all blocks together; 0 = no limit.
                                ///< Each block finishes the pair it is at
  std::chrono::nanoseconds wall{0};  ///< per tick and thread; 0 = no limit
  /// [ticks] A pair that is near for longer without a new answer is expired: its force fades, and
  /// is gone after twice that time.
  std::int64_t max_age = 100;
};

namespace detail {

/// A share of the world's pairs. Those that can soon come within range are its candidates; each has
/// a slot of memory, which it keeps until another needs it. All memory is taken at construction.
class PairBlock {
 public:
  /// @param slots for at most so many pairs, at least 0
  PairBlock(const World& world, PairShare share, int slots, const Budget& budget = {})
      : contacts_(world, share, slots, budget.max_age),
        candidates_(memory().slots()),
        singles_(memory().slots()),
        order_(memory().slots()) {}

  /// Evaluates every pair once, so that none enters the first tick unknown, and forgets the forces.
  void prime(const Motion& motion, PartPoses& poses) noexcept {
    PairMemory& memory = pairs().memory();
    for (int place = 0; place < memory.pairs(); ++place) {
      pairs().evaluate(memory.slot_for(memory.share().pair_at(place)), motion, poses);
    }
    pairs().forces().clear();
  }

  /// Makes every pair a candidate for good, and every candidate near. There must be slots for all.
  void watch_all() noexcept {
    all_near_ = true;
    PairMemory& memory = pairs().memory();
    for (int place = 0; place < memory.pairs(); ++place) {
      const PairId id = memory.share().pair_at(place);
      candidates_.add(id, memory.slot_for(id));
    }
    candidates_.sort();
  }

  /// Begins a tick: no force yet.
  void begin(std::int64_t tick) noexcept { contacts_.begin(tick); }

  /// Makes a pair a candidate. False when there is no slot for it: then it is evaluated at once,
  /// from a cold start, if it can be near.
  /// @param distance [m] proven from below
  bool take(PairId id, std::int32_t seeker, double distance, const Motion& motion,
            PartPoses& poses) noexcept {
    PairMemory& memory = pairs().memory();
    const int slot = memory.slot_for(id);
    pairs().watch_for(slot, motion, distance - pairs().pair(slot).law.range);
    if (memory.is_lent(slot)) {
      PairTotals& totals = pairs().forces().totals;
      ++totals.crowded;
      if (pairs().is_due(slot, motion)) {
        ++totals.near;
        pairs().evaluate(slot, motion, poses);
        pairs().push(slot, motion);
      }
      return false;
    }
    memory.watch(slot).taken = true;
    if (memory.enlist(slot, seeker)) candidates_.add(id, slot);
    return true;
  }

  /// The list of that seeker is complete: those of its candidates that were not taken are none now,
  /// but for contacts, which leave when their evaluation says so, in whatever way the pairs are
  /// watched. Returns how many of these there are.
  int end(std::int32_t seeker) noexcept {
    int contacts = 0;
    candidates_.remove_if([&](std::int32_t slot) {
      PairWatch& watch = pairs().memory().watch(slot);
      const bool missing = watch.seeker == seeker && !watch.taken;
      const bool left = missing && watch.seat < 0;
      contacts += missing && !left ? 1 : 0;
      if (left) pairs().drop(slot);
      watch.taken = false;
      return left;
    });
    candidates_.sort();
    return contacts;
  }

  /// Works through the candidates until `work_units` are spent or `deadline` is reached. When the
  /// last tick could not answer all, half of what it could goes to the most urgent, and the others
  /// follow in turn from where it had to stop, so that no pair starves. The pair in hand is
  /// finished: half an answer would cost most of a whole one and might say less than the old one.
  /// And a pair without any answer is asked in any case.
  void run(const Motion& motion, PartPoses& poses, std::int64_t work_units,
           std::chrono::steady_clock::time_point deadline) noexcept {
    const bool counted = work_units < std::numeric_limits<std::int64_t>::max();
    // Contacts are answered several at a time: what that costs would be known too late.
    if (counted) contacts_.unseat_all(poses);
    find_singles(motion, poses);
    answer(motion, poses, work_units, deadline);
    // In an order that does not depend on which were asked first.
    contacts_.push_contacts(motion);
    for (int k = 0; k < single_count_; ++k) pairs().push(singles_[k], motion);
    contacts_.dismiss(poses);
    for (int k = 0; !counted && k < single_count_; ++k) contacts_.seat(singles_[k], poses);
  }

  /// Does the work of the last tick on up to `most` near pairs again, without any effect. Returns
  /// how many.
  int rehearse(const Motion& motion, PartPoses& poses, int most) noexcept {
    int done = contacts_.rehearse(most, motion, poses);
    for (int k = 0; k < single_count_ && done < most; ++k, ++done) {
      pairs().rehearse(singles_[k], poses);
    }
    return done;
  }

  [[nodiscard]] const PairForces& forces() const noexcept { return contacts_.pairs().forces(); }
  /// The last answer that is remembered; the default one, which claims nothing, where none is.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const int slot = memory().slot_of(id);
    return slot == PairMemory::none ? Separation{} : contacts_.separation_of(slot);
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    return contacts_.extremes_of(id);
  }
  /// see(NearPair) for each pair that was near at `run` with the same motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const auto near = contacts_.near_pair(candidate.slot, motion);
      if (near) see(*near);
    }
  }
  [[nodiscard]] const PairMemory& memory() const noexcept { return contacts_.pairs().memory(); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] PairEvaluator& pairs() noexcept { return contacts_.pairs(); }

  [[nodiscard]] static bool is_over(Clock::time_point deadline) noexcept {
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
  }

  void find_singles(const Motion& motion, PartPoses& poses) noexcept {
    single_count_ = 0;
    // Every contact is a candidate.
    if (candidates_.all().size() > static_cast<std::size_t>(contacts_.count()))
      look_for_singles(motion, poses);
    pairs().forces().totals.near += contacts_.count() + single_count_;
  }

  void look_for_singles(const Motion& motion, PartPoses& poses) noexcept {
    for (const Candidate& candidate : candidates_.all()) {
      const std::int32_t slot = candidate.slot;
      if (memory().watch(slot).seat >= 0) continue;
      if (all_near_ || comes_in_range(slot, motion, poses)) singles_[single_count_++] = slot;
    }
  }

  /// What the travel of the bodies does not exclude is looked at once more, along the direction
  /// that parted the pair: first by how far the bodies have moved, then, if it is their turning
  /// that spoils the proof, by the shapes.
  [[nodiscard]] bool comes_in_range(int slot, const Motion& motion, PartPoses& poses) noexcept {
    if (!pairs().is_due(slot, motion)) return false;
    if (memory().answer(slot).inside) return true;
    const double range = pairs().pair(slot).law.range;
    double clearance = pairs().widened(slot, motion) - range;
    if (!(clearance > 0.0) && clearance + pairs().turned(slot, motion) > 0.0) {
      clearance = pairs().parted_by(slot, motion, poses) - range;
    }
    pairs().watch_for(slot, motion, clearance);
    if (clearance > 0.0) return false;
    pairs().forget_course(slot);
    return true;
  }

  /// The contacts, which share the work, and the single pairs. When there is not time for all, they
  /// take turns to be first.
  void answer(const Motion& motion, PartPoses& poses, std::int64_t work_units,
              Clock::time_point deadline) noexcept {
    const int before = pairs().forces().totals.evaluated;
    spent_ = false;
    if (singles_first_) answer_singles(motion, poses, work_units, deadline);
    answer_groups(motion, poses, deadline);
    if (!singles_first_) answer_singles(motion, poses, work_units, deadline);
    // A turn in which nothing could be answered is none.
    if (!spent_)
      singles_first_ = false;
    else if (pairs().forces().totals.evaluated > before)
      singles_first_ = !singles_first_;
  }

  void answer_groups(const Motion& motion, PartPoses& poses, Clock::time_point deadline) noexcept {
    const int groups = contacts_.groups();
    if (next_group_ >= groups) next_group_ = 0;
    for (int k = 0; k < groups; ++k) {
      const int g = next_group_ + k < groups ? next_group_ + k : next_group_ + k - groups;
      if (spent_ || is_over(deadline)) {
        spent_ = true;
        next_group_ = g;
        return;
      }
      contacts_.evaluate_group(g, motion, poses);
    }
  }

  void answer_singles(const Motion& motion, PartPoses& poses, std::int64_t work_units,
                      Clock::time_point deadline) noexcept {
    const PairTotals& totals = pairs().forces().totals;
    const auto order = in_order(motion);
    int answered = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int slot = singles_[order[k]];
      if (!spent_ && (totals.iterations >= work_units || is_over(deadline))) {
        spent_ = true;
        if (k >= static_cast<std::size_t>(urgent_)) next_ = memory().watch(slot).pair;
      }
      if (spent_ && memory().answer(slot).known()) continue;
      ++answered;
      pairs().evaluate(slot, motion, poses);
    }
    urgent_ = spent_ ? answered / 2 : 0;
  }

  /// The single pairs, the most urgent first if there was not enough time at the last tick.
  [[nodiscard]] std::span<const std::int32_t> in_order(const Motion& motion) noexcept {
    urgent_ = std::min(urgent_, single_count_);
    const auto begin = singles_.begin();
    const auto first = std::lower_bound(
        begin, begin + single_count_, next_.index,
        [&](std::int32_t slot, std::int32_t i) { return memory().watch(slot).pair.index < i; });
    return order_.arrange(
        single_count_, static_cast<int>(first - begin), urgent_,
        [&](std::int32_t k) { return pairs().time_to_contact(singles_[k], motion); });
  }

  ContactEvaluator contacts_;
  Candidates candidates_;
  bool all_near_ = false;
  std::vector<std::int32_t> singles_;  ///< slots of the near pairs that are no contacts
  int single_count_ = 0;
  AnswerOrder order_;
  bool spent_ = false;  ///< there was not time for all in this tick
  bool singles_first_ = false;
  PairId next_{0};      ///< the first single pair whose turn it is
  int next_group_ = 0;  ///< and the first group
  int urgent_ = 0;      ///< so many single pairs come before all others
};

}  // namespace detail
}  // namespace repel
