// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Broad phase: the search for pairs that can soon come within range. It is repeated only when the
/// bodies have moved far enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/lanes.hpp>
#include <repel/pairs/body_view.hpp>
#include <repel/pairs/pair_index.hpp>

namespace repel::detail {

/// The result of a search: no box but those found was nearer than `others` to `box`.
struct Searched {
  static constexpr double never = -std::numeric_limits<double>::infinity();

  Box box;                ///< [m] asked about, in the frame of the tree
  double others = never;  ///< [m]

  /// A lower bound [m] of the distance from `now` to the boxes that were not found: no point of
  /// `now` is farther from `box` than the two boxes differ.
  [[nodiscard]] double distance_to_others(const Box& now) const noexcept {
    double squares = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double outside =
          std::max({box.min()[axis] - now.min()[axis], now.max()[axis] - box.max()[axis], 0.0});
      squares += outside * outside;
    }
    return others - std::sqrt(squares);
  }
};

/// Searches the trees of a PairIndex for the pairs that can come within range before the bodies
/// have moved by a margin, and repeats the search when they have. Two levels: first the lists whose
/// parts can come near the other body (the active lists), then the pairs of each active list. What
/// counts is the displacement since the last search, in the frame of the other body: it is computed
/// when the travel of the bodies says that it may have used up the margin. So bodies that move to
/// and fro, or together, cause no search.
class PairSearch {
 public:
  /// [m] Motion until the next search of a list, and until the next search of two bodies for active
  /// lists. Larger margins mean fewer searches and more candidates.
  static constexpr double margin = 0.02;
  static constexpr double margin_of_bodies = 0.2;

  explicit PairSearch(std::shared_ptr<const PairIndex> index)
      : index_(std::move(index)),
        lists_(index_->lists.size()),
        active_(index_->lists.size()),
        due_(index_->lists.size()),
        body_pairs_(index_->body_pairs.size()) {
    for (std::size_t m = 0; m < body_pairs_.size(); ++m) {
      if (index_->body_pairs[m].is_loose) loose_.push_back(m);
    }
  }

  /// Searches the lists that are due. For each list it calls `sink.take(pair, list, distance)` for
  /// every pair found, with a lower bound [m] of the distance, then `sink.end(list)`: the pairs of
  /// that list that were not found are out of reach. `take` returns false for a pair that it could
  /// not accept; its list is then searched again at the next tick. `end` returns how many
  /// out-of-reach pairs it keeps for now. Before all that it calls `sink.drop(list)` for lists of
  /// bodies that no longer act on each other, or one of which has gone and come back: their pairs
  /// are no longer what they were.
  /// Cost: one comparison for each two bodies none of whose lists is due, else one for each of
  /// their active lists; about 50 ns for a list that is due, and 10 ns per node of its tree.
  template <class Sink>
  void run(const Motion& motion, Sink&& sink) noexcept {
    if (motion.changes != changes_) follow_changes(motion, sink);
    for (std::size_t m = 0; m < body_pairs_.size(); ++m) {
      const PairIndex::BodyPair& body_pair = index_->body_pairs[m];
      BodyPairState& state = body_pairs_[m];
      const BodyState& A = motion.bodies[body_pair.a.index];
      const BodyState& B = motion.bodies[body_pair.b.index];
      const double travel = A.travel + B.travel;
      if (travel < state.next) continue;
      if (!(travel < state.activate_at)) {
        activate(body_pair, state, BodyView(B.X_WB, A.X_WB), travel, sink);
      }
      search_due(body_pair, state, BodyView(A.X_WB, B.X_WB), travel, sink);
    }
  }

  /// Makes everything due, whatever was found before: for a sink that has lost it.
  void repeat() noexcept {
    for (BodyPairState& state : body_pairs_) {
      state.next = state.activate_at = at_once;
      state.last = {};
      state.is_off = false;
    }
    for (ListState& list : lists_) list.last = {};
    std::fill(due_.begin(), due_.end(), at_once);
    changes_ = -1;
  }

 private:
  /// Share of a margin below which the rest of it is not used up: it would be soon.
  static constexpr double least_rest = 0.25;
  static constexpr double at_once = -std::numeric_limits<double>::infinity();
  static constexpr double never = std::numeric_limits<double>::infinity();

  struct ListState {
    Searched last;           ///< in the frame of the other body
    std::int32_t count = 0;  ///< pairs found at the last search, and those kept
    bool active = false;
    bool found = false;  ///< by the running search for active lists
  };
  struct BodyPairState {
    double next = at_once;         ///< [m] travel of both bodies at which a search is due
    double activate_at = at_once;  ///< [m] same, for the search for active lists
    Searched last;                 ///< by that search, in the frame of a
    std::int32_t active = 0;  ///< number of active lists, from `BodyPair::first` on in `active_`
    bool is_off = false;      ///< the bodies do not act on each other: no search
    std::int32_t generation = 0;  ///< sum of how often either of the bodies has come
  };

  /// Turns the search for the pairs of two bodies on or off, or begins it anew, where bodies have
  /// come, gone or changed hands. Cost: a look at each two bodies of which one can come and go.
  template <class Sink>
  void follow_changes(const Motion& motion, Sink& sink) noexcept {
    changes_ = motion.changes;
    for (const std::size_t m : loose_) {
      const PairIndex::BodyPair& body_pair = index_->body_pairs[m];
      BodyPairState& state = body_pairs_[m];
      const BodyState& A = motion.bodies[body_pair.a.index];
      const BodyState& B = motion.bodies[body_pair.b.index];
      const bool is_off = !share_between(A, B).acts();
      const std::int32_t generation = A.presence.generation + B.presence.generation;
      if (is_off == state.is_off && generation == state.generation) continue;
      for (std::int32_t i = body_pair.first; i < body_pair.first + state.active; ++i) {
        sink.drop(active_[i]);
        lists_[active_[i]] = {};
        due_[i] = at_once;
      }
      state = {};
      state.is_off = is_off;
      state.generation = generation;
      if (is_off) state.next = never;
    }
  }

  /// Searches for the lists near the other body, unless the margin is not used up.
  /// @param view from b to a
  /// @param travel [m] of both bodies
  template <class Sink>
  void activate(const PairIndex::BodyPair& body_pair, BodyPairState& state, const BodyView& view,
                double travel, Sink& sink) noexcept {
    const Box partners = view.box(body_pair.partners);
    const double rest = view.lower_bound(state.last.distance_to_others(partners)) - body_pair.range;
    if (rest > least_rest * margin_of_bodies) {
      state.activate_at = travel + rest;
      return;
    }
    const std::int32_t first = body_pair.first;
    std::int32_t end = first + state.active;
    const double others = body_pair.tree.query(
        partners, body_pair.range + margin_of_bodies, [&](std::int32_t i, double distance) {
          ListState& list = lists_[first + i];
          list.found = true;
          if (list.active) return;
          list.active = true;
          // Lower bound of the distance from its part to any partner, minus the range.
          const double clearance = view.lower_bound(distance) - body_pair.range;
          due_[end] = clearance > 0.0 ? travel + clearance : at_once;
          active_[end++] = first + i;
        });
    state.active = 0;
    for (std::int32_t i = first; i < end; ++i) {
      ListState& list = lists_[active_[i]];
      if (!list.found) {
        leave(active_[i], sink);
        due_[i] = at_once;
      }
      list.found = false;
      if (!list.active) continue;
      due_[first + state.active] = due_[i];
      active_[first + state.active++] = active_[i];
    }
    state.last = {partners, others};
    state.activate_at = travel + view.lower_bound(others) - body_pair.range;
  }

  /// Drops the pairs of a list, which remains active while the sink keeps some.
  template <class Sink>
  void leave(std::int32_t s, Sink& sink) noexcept {
    ListState& list = lists_[s];
    if (list.count > 0) list.count = sink.end(s);
    list.active = list.count > 0;
    list.last = {};
  }

  /// Searches the lists that are due.
  /// @param view from a to b
  /// @param travel [m] of both bodies
  template <class Sink>
  void search_due(const PairIndex::BodyPair& body_pair, BodyPairState& state, const BodyView& view,
                  double travel, Sink& sink) noexcept {
    for (std::int32_t i = body_pair.first; i < body_pair.first + state.active; ++i) {
      if (!(travel < due_[i])) due_[i] = search(active_[i], view, travel, sink);
    }
    const std::span due(due_.data() + body_pair.first, static_cast<std::size_t>(state.active));
    state.next = std::min(state.activate_at, least(due));
  }

  /// Searches a list, unless its margin is not used up. Returns when it is due next.
  template <class Sink>
  double search(std::int32_t list, const BodyView& view, double travel, Sink& sink) noexcept {
    const PairIndex::PairList& pairs = index_->lists[list];
    ListState& state = lists_[list];
    const Box box = view.box(pairs.box);
    const double rest = view.lower_bound(state.last.distance_to_others(box)) - pairs.range;
    if (rest > least_rest * margin) return travel + rest;
    // The first margins differ, so that the lists do not all become due at the same tick later.
    const double share = state.last.others > Searched::never ? 1.0 : 0.125 * (list % 8 + 1);
    const std::int32_t before = state.count;
    state.count = 0;
    bool all_taken = true;
    const double others = index_->trees[pairs.tree].query(
        box, pairs.range + share * margin, [&](std::int32_t i, double distance) {
          const PairId pair = index_->pairs[pairs.first + i];
          ++state.count;
          all_taken = sink.take(pair, list, view.lower_bound(distance)) && all_taken;
        });
    if (before + state.count > 0) state.count += sink.end(list);
    state.last = {box, all_taken ? others : Searched::never};
    return all_taken ? travel + view.lower_bound(others) - pairs.range : at_once;
  }

  [[nodiscard]] static double least(std::span<const double> numbers) noexcept {
    Lanes least = all_of(std::numeric_limits<double>::infinity());
    std::size_t i = 0;
    for (Lanes some; i + lane_count <= numbers.size(); i += lane_count) {
      std::memcpy(&some, &numbers[i], sizeof some);
      least = smaller(least, some);
    }
    double least_of_all = least_of(least);
    for (; i < numbers.size(); ++i) least_of_all = std::min(least_of_all, numbers[i]);
    return least_of_all;
  }

  std::shared_ptr<const PairIndex> index_;
  std::vector<ListState> lists_;
  std::vector<std::int32_t> active_;  ///< lists, by body pair
  std::vector<double> due_;           ///< [m] travel of both bodies at which each of them is due
  std::vector<BodyPairState> body_pairs_;
  std::vector<std::size_t> loose_;  ///< those of which one body can come and go
  std::int64_t changes_ = -1;       ///< Motion::changes at the last run
};

}  // namespace repel::detail
