/// @file
/// Which pairs can soon come within range: found among all of them by trees that are built once,
/// and asked again only when the bodies have moved far enough.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include <repel/schedule/body_view.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// A part as a box around it in the frame of its body.
[[nodiscard]] inline Box box_of(const Part& part) noexcept {
  const Level& shape = part.shape.level(0);
  Box box(part.X_BP.translation());
  for (int axis = 0; axis < 3; ++axis) {
    const Vec<double> d(Vec3(part.X_BP.linear().row(axis)));
    box.max()[axis] += shape.core.support_value(d) + shape.depth;
    box.min()[axis] -= shape.core.support_value(-d) + shape.depth;
  }
  return box;
}

/// The pairs of a world, ordered for the search. Of two bodies the one whose parts in their pairs
/// are spread wider is the seeking one, since most of them are far from the other: each of its
/// parts has its partners on the other body, which lie still in that body's frame. Seekers with the
/// same partners share one tree, and all seekers of two bodies stand in another, by which those
/// near the other body are found.
struct PairIndex {
  /// A part and the pairs it forms with one other body.
  struct Seeker {
    Box box;             ///< [m] in the frame of its body
    double range = 0.0;  ///< [m] greatest of its pairs
    std::int32_t tree = 0;
    std::int32_t first = 0;  ///< of its pairs in `pairs`, in the order of the tree's boxes
  };
  /// Two bodies and the seekers of the first.
  struct Meeting {
    BodyId a;
    BodyId b;
    std::int32_t first = 0;
    std::int32_t end = 0;
    BoxTree tree;        ///< over the seekers, in the frame of a
    Box partners;        ///< [m] around all of them, in the frame of b
    double range = 0.0;  ///< [m] greatest of all pairs
  };

  /// Of no pairs.
  PairIndex() = default;
  /// Allocates: about 60 bytes for each box of a tree and 4 for each pair.
  explicit PairIndex(const World& world) {
    for (const Part& part : world.parts()) boxes_.push_back(box_of(part));
    std::vector<Entry> entries = entries_of(world);
    std::sort(entries.begin(), entries.end());
    for (auto first = entries.begin(); first != entries.end();) {
      const auto end = std::find_if(
          first, entries.end(), [&](const Entry& e) { return e.a != first->a || e.b != first->b; });
      turn_to_wider(first, end);
      add_meeting(world, first, end);
      first = end;
    }
    boxes_ = {};
  }

  std::vector<Meeting> meetings;
  std::vector<Seeker> seekers;
  std::vector<PairId> pairs;
  std::vector<BoxTree> trees;

 private:
  struct Entry {
    std::int32_t a, b, part_a, part_b, pair;
    friend bool operator<(const Entry& e, const Entry& f) {
      return std::tie(e.a, e.b, e.part_a, e.part_b, e.pair) <
             std::tie(f.a, f.b, f.part_a, f.part_b, f.pair);
    }
    [[nodiscard]] Entry turned() const { return {b, a, part_b, part_a, pair}; }
  };
  using Place = std::vector<Entry>::iterator;

  static std::vector<Entry> entries_of(const World& world) {
    std::vector<Entry> entries;
    entries.reserve(world.pairs().size());
    for (const Pair& pair : world.pairs()) {
      const auto i = static_cast<std::int32_t>(entries.size());
      const Entry entry{world.part(pair.a).body.index, world.part(pair.b).body.index, pair.a.index,
                        pair.b.index, i};
      entries.push_back(entry.a < entry.b ? entry : entry.turned());
    }
    return entries;
  }

  void turn_to_wider(Place first, Place end) const {
    Box of_a, of_b;
    for (auto e = first; e != end; ++e) {
      of_a.extend(boxes_[e->part_a]);
      of_b.extend(boxes_[e->part_b]);
    }
    if (of_a.sizes().norm() >= of_b.sizes().norm()) return;
    std::transform(first, end, first, [](const Entry& e) { return e.turned(); });
    std::sort(first, end);
  }

  void add_meeting(const World& world, Place first, Place end) {
    Meeting meeting;
    meeting.a = {first->a};
    meeting.b = {first->b};
    meeting.first = static_cast<std::int32_t>(seekers.size());
    std::vector<Box> boxes;
    std::map<std::vector<std::int32_t>, std::int32_t> tree_of;
    while (first != end) {
      Seeker seeker{boxes_[first->part_a], 0.0, 0, static_cast<std::int32_t>(pairs.size())};
      std::vector<std::int32_t> partners;
      for (const std::int32_t a = first->part_a; first != end && first->part_a == a; ++first) {
        seeker.range = std::max(seeker.range, world.pair({first->pair}).law.range);
        partners.push_back(first->part_b);
        meeting.partners.extend(boxes_[first->part_b]);
        pairs.push_back({first->pair});
      }
      const auto [tree, is_new] =
          tree_of.try_emplace(std::move(partners), static_cast<std::int32_t>(trees.size()));
      if (is_new) trees.push_back(tree_around(tree->first));
      seeker.tree = tree->second;
      seekers.push_back(seeker);
      boxes.push_back(seeker.box);
      meeting.range = std::max(meeting.range, seeker.range);
    }
    meeting.end = static_cast<std::int32_t>(seekers.size());
    meeting.tree = BoxTree(boxes);
    meetings.push_back(std::move(meeting));
  }

  [[nodiscard]] BoxTree tree_around(const std::vector<std::int32_t>& parts) const {
    std::vector<Box> boxes;
    boxes.reserve(parts.size());
    for (const std::int32_t i : parts) boxes.push_back(boxes_[i]);
    return BoxTree(boxes);
  }

  std::vector<Box> boxes_;  ///< [m] by PartId, while the index is built
};

/// Asks the trees of a PairIndex for the pairs that can come within range before the bodies have
/// moved by a margin, and again when they have. First which seekers can come near the other body:
/// these are awake. Then each of them by itself, which of its partners.
class PairSearch {
 public:
  /// [m] More of them makes for fewer questions and longer lists.
  static constexpr double margin = 0.03;
  static constexpr double margin_of_bodies = 0.2;

  explicit PairSearch(std::shared_ptr<const PairIndex> index)
      : index_(std::move(index)),
        seekers_(index_->seekers.size()),
        awake_(index_->seekers.size()),
        meetings_(index_->meetings.size()) {}

  /// Renews the lists that are due. For each: `sink.take(pair, seeker, distance)` for every pair
  /// on it, with a distance [m] no more than the true one, then `sink.end(seeker)`: the pairs of
  /// that seeker that were not taken are out of reach. It answers how many of them it keeps for
  /// the time being. A pair that is not taken in, by the answer false, is offered again.
  /// Cost: one comparison for each two bodies in whose pairs nothing is due.
  template <class Sink>
  void run(const Motion& motion, Sink&& sink) noexcept {
    for (std::size_t m = 0; m < meetings_.size(); ++m) {
      const PairIndex::Meeting& meeting = index_->meetings[m];
      const BodyState& A = motion.bodies[meeting.a.index];
      const BodyState& B = motion.bodies[meeting.b.index];
      const double travel = A.travel + B.travel;
      if (travel < meetings_[m].next) continue;
      if (!(travel < meetings_[m].wake_at)) wake(meeting, meetings_[m], A, B, sink);
      double next = meetings_[m].wake_at;
      for (std::int32_t i = 0; i < meetings_[m].awake; ++i) {
        const std::int32_t s = awake_[meeting.first + i];
        if (!(travel < seekers_[s].ask_at)) ask(s, A, B, sink);
        next = std::min(next, seekers_[s].ask_at);
      }
      meetings_[m].next = next;
    }
  }

 private:
  static constexpr double never_asked = -std::numeric_limits<double>::infinity();
  static constexpr double again = std::numeric_limits<double>::lowest();

  struct SeekerState {
    double ask_at = never_asked;  ///< [m] of travel of both bodies
    std::int32_t listed = 0;      ///< pairs on its list
    bool awake = false;
    bool found = false;  ///< again, while the seekers are woken
  };
  struct MeetingState {
    double next = never_asked;     ///< [m] of travel of both bodies when something is due
    double wake_at = never_asked;  ///< [m] and when the seekers are woken again
    std::int32_t awake = 0;        ///< so many, from `Meeting::first` on in `awake_`
  };

  template <class Sink>
  void wake(const PairIndex::Meeting& meeting, MeetingState& state, const BodyState& A,
            const BodyState& B, Sink& sink) noexcept {
    const BodyView view(B.X_WB, A.X_WB);
    const std::int32_t before = state.awake;
    const double travel = A.travel + B.travel;
    const double others =
        meeting.tree.query(view.box(meeting.partners), meeting.range + margin_of_bodies,
                           [&](std::int32_t i, double distance) {
                             SeekerState& seeker = seekers_[meeting.first + i];
                             seeker.found = true;
                             if (seeker.awake) return;
                             seeker.awake = true;
                             // It has no partner nearer than that.
                             const double clearance = view.sure(distance) - meeting.range;
                             seeker.ask_at = clearance > 0.0 ? travel + clearance : never_asked;
                             awake_[meeting.first + state.awake++] = meeting.first + i;
                           });
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < state.awake; ++i) {
      const std::int32_t s = awake_[meeting.first + i];
      SeekerState& seeker = seekers_[s];
      const bool leaves = i < before && !seeker.found;
      if (leaves && seeker.listed > 0) seeker.listed = sink.end(s);
      seeker.awake = !leaves || seeker.listed > 0;
      if (seeker.awake) awake_[meeting.first + kept++] = s;
      seeker.found = false;
    }
    state.awake = kept;
    state.wake_at = travel + view.sure(others) - meeting.range;
  }

  template <class Sink>
  void ask(std::int32_t s, const BodyState& A, const BodyState& B, Sink& sink) noexcept {
    const BodyView view(A.X_WB, B.X_WB);
    const double travel = A.travel + B.travel;
    const PairIndex::Seeker& seeker = index_->seekers[s];
    SeekerState& state = seekers_[s];
    // The first margins differ, so that later not all seekers are due in one tick.
    const double share = state.ask_at > never_asked ? 1.0 : 0.125 * (s % 8 + 1);
    const std::int32_t before = state.listed;
    state.listed = 0;
    bool all_taken = true;
    const double others = index_->trees[seeker.tree].query(
        view.box(seeker.box), seeker.range + share * margin, [&](std::int32_t i, double distance) {
          const PairId pair = index_->pairs[seeker.first + i];
          ++state.listed;
          all_taken = sink.take(pair, s, view.sure(distance)) && all_taken;
        });
    if (before + state.listed > 0) state.listed += sink.end(s);
    state.ask_at = all_taken ? travel + view.sure(others) - seeker.range : again;
  }

  std::shared_ptr<const PairIndex> index_;
  std::vector<SeekerState> seekers_;
  std::vector<std::int32_t> awake_;  ///< seekers, by meeting
  std::vector<MeetingState> meetings_;
};

}  // namespace repel::detail
