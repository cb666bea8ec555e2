// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which near pairs are evaluated in a tick that may be too short for all, in which order, and by
/// which thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/pairs/budget.hpp>
#include <repel/pairs/evaluation_order.hpp>
#include <repel/pairs/forces_and_totals.hpp>

namespace repel::detail {

/// The items of a tick, lane groups and single pairs, in batches of a few. If the last tick could
/// not evaluate all, half the number of singles it managed is selected by urgency; the others, and
/// the groups, follow round-robin from where it stopped, so that none starves; and groups and
/// singles alternate in going first. All memory is allocated at construction.
class EvaluationPlan {
 public:
  /// @param groups,singles the largest numbers of these in a tick
  EvaluationPlan(int groups, int singles)
      : order_(singles), batches_(static_cast<std::size_t>(batches_of(groups + singles))) {}

  /// Plans a tick. Returns the number of batches. @param key_at(k) of the k-th single: ascending,
  /// and the same at every tick @param urgency(k) the key of its urgency, smallest first
  template <class KeyAt, class Urgency>
  int plan(const EvaluationLimit& limit, int groups, int singles, const KeyAt& key_at,
           const Urgency& urgency) noexcept {
    limit_ = limit;
    groups_ = groups;
    singles_ = singles;
    count_ = batches_of(groups + singles);
    if (first_group_ >= groups) first_group_ = 0;
    urgent_ = std::min(evaluated_singles_ / 2, singles);
    in_order_ = {};
    if (limit.is_set()) {
      int first = 0;
      for (int end = singles; first < end;) {  // lower bound
        const int middle = first + (end - first) / 2;
        if (key_at(middle) < first_key_) {
          first = middle + 1;
        } else {
          end = middle;
        }
      }
      in_order_ = order_.arrange(singles, first, urgent_, urgency);
    }
    return count_;
  }

  /// Goes through a batch: calls evaluate_group(g, totals) and evaluate_single(k, allowed, totals)
  /// for its items, without the groups for which there is no time. Different batches may be run by
  /// different threads. @param spent support-map pairs before it. Returns how many it took.
  template <class EvaluateGroup, class EvaluateSingle>
  std::int64_t run(int batch, std::int64_t spent, const EvaluateGroup& evaluate_group,
                   const EvaluateSingle& evaluate_single) noexcept {
    Batch& b = batches_[static_cast<std::size_t>(batch)];
    b = {};
    const int end = std::min((batch + 1) * batch_size, groups_ + singles_);
    for (int item = batch * batch_size; item < end; ++item) {
      if (b.stopped_at < 0 && limit_.is_set() && limit_.is_reached(spent + b.totals.iterations)) {
        b.stopped_at = item;
      }
      const bool allowed = b.stopped_at < 0;
      if (is_single(item)) {
        const int before = b.totals.evaluated;
        evaluate_single(single_of(item), allowed, b.totals);
        b.singles += b.totals.evaluated - before;
      } else if (allowed) {
        evaluate_group(group_of(item), b.totals);
      }
    }
    return b.totals.iterations;
  }

  /// After all batches: adds up what they did, in a fixed order, and notes where the next tick
  /// begins. @param key_at as in `plan`
  template <class KeyAt>
  void finish(PairTotals& totals, const KeyAt& key_at) noexcept {
    int stopped_at = -1;
    int evaluated = 0;
    evaluated_singles_ = 0;
    for (int k = 0; k < count_; ++k) {
      const Batch& batch = batches_[static_cast<std::size_t>(k)];
      totals.add(batch.totals);
      evaluated_singles_ += batch.singles;
      evaluated += batch.totals.evaluated;
      if (stopped_at < 0) stopped_at = batch.stopped_at;
    }
    if (stopped_at < 0) {
      evaluated_singles_ = 0;
      singles_first_ = false;
      return;
    }
    if (!is_single(stopped_at)) {
      first_group_ = group_of(stopped_at);
    } else if (place_of(stopped_at) >= urgent_) {
      first_key_ = key_at(single_of(stopped_at));
    }
    // A turn in which nothing could be evaluated does not count.
    if (evaluated > 0) singles_first_ = !singles_first_;
  }

  [[nodiscard]] const EvaluationLimit& limit() const noexcept { return limit_; }
  [[nodiscard]] int batches() const noexcept { return count_; }

 private:
  static constexpr int batch_size = 8;

  struct Batch {
    PairTotals totals;
    int stopped_at = -1;  ///< the first item that the limit did not allow; -1: none
    int singles = 0;      ///< evaluated
  };

  [[nodiscard]] static int batches_of(int items) noexcept;
  [[nodiscard]] bool is_single(int item) const noexcept;
  /// The place of a single in the order of this tick.
  [[nodiscard]] int place_of(int item) const noexcept;
  [[nodiscard]] int single_of(int item) const noexcept;
  [[nodiscard]] int group_of(int item) const noexcept;

  EvaluationLimit limit_;
  int groups_ = 0;
  int singles_ = 0;
  int count_ = 0;  ///< batches of this tick
  EvaluationOrder order_;
  std::span<const std::int32_t> in_order_;  ///< the singles of this tick; empty: in ascending order
  std::vector<Batch> batches_;
  bool singles_first_ = false;
  std::int64_t first_key_ = 0;  ///< round-robin start of the singles
  int first_group_ = 0;         ///< round-robin start of the groups
  int evaluated_singles_ = 0;   ///< at the last tick, if the time did not suffice for all
  int urgent_ = 0;              ///< singles selected by urgency at this tick
};

inline int EvaluationPlan::batches_of(int items) noexcept {
  return (items + batch_size - 1) / batch_size;
}

inline bool EvaluationPlan::is_single(int item) const noexcept {
  return singles_first_ ? item < singles_ : item >= groups_;
}

inline int EvaluationPlan::place_of(int item) const noexcept {
  return singles_first_ ? item : item - groups_;
}

inline int EvaluationPlan::single_of(int item) const noexcept {
  const int place = place_of(item);
  return in_order_.empty() ? place : in_order_[static_cast<std::size_t>(place)];
}

inline int EvaluationPlan::group_of(int item) const noexcept {
  const int g = first_group_ + (singles_first_ ? item - singles_ : item);
  return g < groups_ ? g : g - groups_;
}

}  // namespace repel::detail
