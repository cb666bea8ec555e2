/// @file
/// Broad phase: the search for pairs that can soon come within range. Its box trees are built once,
/// and it is repeated only when the bodies have moved far enough.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include <repel/pairs/body_view.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// The bounding box of a part in the frame of its body.
[[nodiscard]] inline Box box_of(const Part& part) noexcept {
  const Level& shape = part.shape.level(0);
  Box box(origin(part.X_BP));
  for (int axis = 0; axis < 3; ++axis) {
    const double* row = part.X_BP.data() + axis;
    const Vec<double> d(row[0], row[4], row[8]);
    box.max()[axis] += shape.core.support_value(d) + shape.depth;
    box.min()[axis] -= shape.core.support_value(-d) + shape.depth;
  }
  return box;
}

/// The pairs of a world, indexed for the search. The pairs of two bodies a and b are divided into
/// lists: one for each part of a, with its partners on b. Body a is the one whose parts span the
/// larger box, since most of these are far from the other body. The partners are fixed in the frame
/// of b, so a tree of their boxes is built there; lists with the same partners share it. A second
/// tree, over the parts of a that have a list, yields the lists near the other body.
struct PairIndex {
  /// The pairs of one part with the parts of one other body.
  struct PairList {
    Box box;             ///< [m] around the part, in the frame of its body
    double range = 0.0;  ///< [m] largest range of its pairs
    std::int32_t tree = 0;
    std::int32_t first = 0;  ///< of its pairs in `pairs`, in the order of the tree's boxes
  };
  /// Two bodies and the lists of the parts of the first.
  struct BodyPair {
    BodyId a;
    BodyId b;
    std::int32_t first = 0;  ///< of its lists
    std::int32_t end = 0;    ///< behind the last of them
    BoxTree tree;            ///< over the parts that have lists, in the frame of a
    Box partners;            ///< [m] around all partners, in the frame of b
    double range = 0.0;      ///< [m] largest range of all its pairs
  };

  /// An empty index.
  PairIndex() = default;
  /// Allocates: about 60 bytes for each box of a tree and 4 for each pair.
  /// @param lookahead [m] added to the range of every pair
  explicit PairIndex(const World& world, double lookahead = 0.0) : lookahead_(lookahead) {
    for (const Part& part : world.parts()) boxes_.push_back(box_of(part));
    std::vector<Entry> entries = entries_of(world);
    std::sort(entries.begin(), entries.end());
    for (auto first = entries.begin(); first != entries.end();) {
      const auto end = std::find_if(
          first, entries.end(), [&](const Entry& e) { return e.a != first->a || e.b != first->b; });
      put_wider_first(first, end);
      add_body_pair(world, first, end);
      first = end;
    }
    boxes_ = {};
  }

  std::vector<BodyPair> body_pairs;
  std::vector<PairList> lists;
  std::vector<PairId> pairs;
  std::vector<BoxTree> trees;

 private:
  struct Entry {
    std::int32_t a, b, part_a, part_b, pair;
    friend bool operator<(const Entry& e, const Entry& f) {
      return std::tie(e.a, e.b, e.part_a, e.part_b, e.pair) <
             std::tie(f.a, f.b, f.part_a, f.part_b, f.pair);
    }
    [[nodiscard]] Entry swapped() const { return {b, a, part_b, part_a, pair}; }
  };
  using Place = std::vector<Entry>::iterator;

  static std::vector<Entry> entries_of(const World& world) {
    std::vector<Entry> entries;
    entries.reserve(world.pairs().size());
    for (const Pair& pair : world.pairs()) {
      const auto i = static_cast<std::int32_t>(entries.size());
      const Entry entry{world.part(pair.a).body.index, world.part(pair.b).body.index, pair.a.index,
                        pair.b.index, i};
      entries.push_back(entry.a < entry.b ? entry : entry.swapped());
    }
    return entries;
  }

  void put_wider_first(Place first, Place end) const {
    Box of_a, of_b;
    for (auto e = first; e != end; ++e) {
      of_a.extend(boxes_[e->part_a]);
      of_b.extend(boxes_[e->part_b]);
    }
    if (norm(extents(of_a)) >= norm(extents(of_b))) return;
    std::transform(first, end, first, [](const Entry& e) { return e.swapped(); });
    std::sort(first, end);
  }

  void add_body_pair(const World& world, Place first, Place end) {
    BodyPair body_pair;
    body_pair.a = {first->a};
    body_pair.b = {first->b};
    body_pair.first = static_cast<std::int32_t>(lists.size());
    std::vector<Box> boxes;
    std::map<std::vector<std::int32_t>, std::int32_t> tree_of;
    while (first != end) {
      PairList list{boxes_[first->part_a], 0.0, 0, static_cast<std::int32_t>(pairs.size())};
      std::vector<std::int32_t> partners;
      for (const std::int32_t a = first->part_a; first != end && first->part_a == a; ++first) {
        list.range = std::max(list.range, world.pair({first->pair}).law.range + lookahead_);
        partners.push_back(first->part_b);
        body_pair.partners.extend(boxes_[first->part_b]);
        pairs.push_back({first->pair});
      }
      const auto [tree, is_new] =
          tree_of.try_emplace(std::move(partners), static_cast<std::int32_t>(trees.size()));
      if (is_new) trees.push_back(tree_around(tree->first));
      list.tree = tree->second;
      lists.push_back(list);
      boxes.push_back(list.box);
      body_pair.range = std::max(body_pair.range, list.range);
    }
    body_pair.end = static_cast<std::int32_t>(lists.size());
    body_pair.tree = BoxTree(boxes);
    body_pairs.push_back(std::move(body_pair));
  }

  [[nodiscard]] BoxTree tree_around(const std::vector<std::int32_t>& parts) const {
    std::vector<Box> boxes;
    boxes.reserve(parts.size());
    for (const std::int32_t i : parts) boxes.push_back(boxes_[i]);
    return BoxTree(boxes);
  }

  double lookahead_ = 0.0;  ///< [m]
  std::vector<Box> boxes_;  ///< [m] by PartId, while the index is built
};

/// Searches the trees of a PairIndex for the pairs that can come within range before the bodies
/// have moved by a margin, and repeats the search when they have. Two levels: first the lists whose
/// parts can come near the other body (the active lists), then the pairs of each active list.
class PairSearch {
 public:
  /// [m] Motion until the next search of a list, and until the next search of two bodies for active
  /// lists. Larger margins mean fewer searches and more candidates.
  static constexpr double margin = 0.03;
  static constexpr double margin_of_bodies = 0.2;

  explicit PairSearch(std::shared_ptr<const PairIndex> index)
      : index_(std::move(index)),
        lists_(index_->lists.size()),
        active_(index_->lists.size()),
        body_pairs_(index_->body_pairs.size()) {}

  /// Searches the lists that are due. For each list it calls `sink.take(pair, list, distance)` for
  /// every pair found, with a lower bound [m] of the distance, then `sink.end(list)`: the pairs of
  /// that list that were not found are out of reach. `take` returns false for a pair that it could
  /// not accept; its list is then searched again at the next tick. `end` returns how many
  /// out-of-reach pairs it keeps for now.
  /// Cost: one comparison for each two bodies none of whose lists is due.
  template <class Sink>
  void run(const Motion& motion, Sink&& sink) noexcept {
    for (std::size_t m = 0; m < body_pairs_.size(); ++m) {
      const PairIndex::BodyPair& body_pair = index_->body_pairs[m];
      const BodyState& A = motion.bodies[body_pair.a.index];
      const BodyState& B = motion.bodies[body_pair.b.index];
      const double travel = A.travel + B.travel;
      if (travel < body_pairs_[m].next) continue;
      if (!(travel < body_pairs_[m].activate_at)) activate(body_pair, body_pairs_[m], A, B, sink);
      double next = body_pairs_[m].activate_at;
      for (std::int32_t i = 0; i < body_pairs_[m].active; ++i) {
        const std::int32_t s = active_[body_pair.first + i];
        if (!(travel < lists_[s].search_at)) search(s, A, B, sink);
        next = std::min(next, lists_[s].search_at);
      }
      body_pairs_[m].next = next;
    }
  }

  /// Makes everything due, as if nothing had been found before: for a sink that has lost it.
  void repeat() noexcept {
    for (BodyPairState& state : body_pairs_) {
      state.next = state.activate_at = never_searched;
    }
    for (ListState& list : lists_) list.search_at = never_searched;
  }

 private:
  static constexpr double never_searched = -std::numeric_limits<double>::infinity();
  static constexpr double again = std::numeric_limits<double>::lowest();

  struct ListState {
    double search_at = never_searched;  ///< [m] travel of both bodies at which it is due
    std::int32_t count = 0;             ///< pairs found at the last search, and those kept
    bool active = false;
    bool found = false;  ///< by the running search for active lists
  };
  struct BodyPairState {
    double next = never_searched;         ///< [m] travel of both bodies at which a search is due
    double activate_at = never_searched;  ///< [m] same, for the search for active lists
    std::int32_t active = 0;  ///< number of active lists, from `BodyPair::first` on in `active_`
  };

  template <class Sink>
  void activate(const PairIndex::BodyPair& body_pair, BodyPairState& state, const BodyState& A,
                const BodyState& B, Sink& sink) noexcept {
    const BodyView view(B.X_WB, A.X_WB);
    const std::int32_t before = state.active;
    const double travel = A.travel + B.travel;
    const double others = body_pair.tree.query(
        view.box(body_pair.partners), body_pair.range + margin_of_bodies,
        [&](std::int32_t i, double distance) {
          ListState& list = lists_[body_pair.first + i];
          list.found = true;
          if (list.active) return;
          list.active = true;
          // Lower bound of the distance from its part to any partner, minus the range.
          const double clearance = view.lower_bound(distance) - body_pair.range;
          list.search_at = clearance > 0.0 ? travel + clearance : never_searched;
          active_[body_pair.first + state.active++] = body_pair.first + i;
        });
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < state.active; ++i) {
      const std::int32_t s = active_[body_pair.first + i];
      ListState& list = lists_[s];
      const bool leaves = i < before && !list.found;
      if (leaves && list.count > 0) list.count = sink.end(s);
      list.active = !leaves || list.count > 0;
      if (list.active) active_[body_pair.first + kept++] = s;
      list.found = false;
    }
    state.active = kept;
    state.activate_at = travel + view.lower_bound(others) - body_pair.range;
  }

  template <class Sink>
  void search(std::int32_t list, const BodyState& A, const BodyState& B, Sink& sink) noexcept {
    const BodyView view(A.X_WB, B.X_WB);
    const double travel = A.travel + B.travel;
    const PairIndex::PairList& pairs = index_->lists[list];
    ListState& state = lists_[list];
    // The first margins differ, so that the lists do not all become due at the same tick later.
    const double share = state.search_at > never_searched ? 1.0 : 0.125 * (list % 8 + 1);
    const std::int32_t before = state.count;
    state.count = 0;
    bool all_taken = true;
    const double others = index_->trees[pairs.tree].query(
        view.box(pairs.box), pairs.range + share * margin, [&](std::int32_t i, double distance) {
          const PairId pair = index_->pairs[pairs.first + i];
          ++state.count;
          all_taken = sink.take(pair, list, view.lower_bound(distance)) && all_taken;
        });
    if (before + state.count > 0) state.count += sink.end(list);
    state.search_at = all_taken ? travel + view.lower_bound(others) - pairs.range : again;
  }

  std::shared_ptr<const PairIndex> index_;
  std::vector<ListState> lists_;
  std::vector<std::int32_t> active_;  ///< lists, by body pair
  std::vector<BodyPairState> body_pairs_;
};

}  // namespace repel::detail
