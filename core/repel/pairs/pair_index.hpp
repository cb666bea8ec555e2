// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pairs of a world, indexed for the search: bounding-volume trees, built once.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <repel/geometry/box_tree.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// The bounding box of a part in the frame of its body, whatever shape it gets while running.
[[nodiscard]] inline Box box_of(const Part& part) noexcept {
  if (part.room > 0.0) {
    const Vec3 room(part.room, part.room, part.room);
    return {-room, room};
  }
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
    bool is_loose = false;   ///< one of the bodies can come and go
  };

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
    friend std::strong_ordering operator<=>(const Entry& e, const Entry& f) = default;
    [[nodiscard]] Entry swapped() const { return {b, a, part_b, part_a, pair}; }
  };
  using Place = std::vector<Entry>::iterator;
  /// The trees of two bodies, by the parts they are around.
  struct TreesByPartners {
    std::vector<std::vector<std::int32_t>> partners;  ///< of each tree
    std::vector<std::int32_t> in_order;               ///< the trees, as `is_before` says
  };

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
    TreesByPartners trees_made;
    while (first != end) {
      PairList list{boxes_[first->part_a], 0.0, 0, static_cast<std::int32_t>(pairs.size())};
      std::vector<std::int32_t> partners;
      for (const std::int32_t a = first->part_a; first != end && first->part_a == a; ++first) {
        list.range = std::max(list.range, world.pair({first->pair}).law.reach() + lookahead_);
        partners.push_back(first->part_b);
        body_pair.partners.extend(boxes_[first->part_b]);
        pairs.push_back({first->pair});
      }
      list.tree = tree_around(std::move(partners), trees_made);
      lists.push_back(list);
      boxes.push_back(list.box);
      body_pair.range = std::max(body_pair.range, list.range);
    }
    body_pair.end = static_cast<std::int32_t>(lists.size());
    for (const BodyId body : {body_pair.a, body_pair.b}) {
      body_pair.is_loose |= world.motion().bodies[static_cast<std::size_t>(body.index)].is_loose;
    }
    body_pair.tree = BoxTree({boxes.data(), boxes.size()});
    body_pairs.push_back(std::move(body_pair));
  }

  /// Any order that tells lists of parts apart.
  static bool is_before(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(std::int32_t)) < 0;
  }

  /// The index of the tree around these parts, which is built unless it is among those `made`.
  std::int32_t tree_around(std::vector<std::int32_t> parts, TreesByPartners& made) {
    const auto first = static_cast<std::int32_t>(trees.size() - made.partners.size());
    const auto place = std::partition_point(
        made.in_order.begin(), made.in_order.end(),
        [&](std::int32_t tree) { return is_before(made.partners[tree], parts); });
    if (place != made.in_order.end() && !is_before(parts, made.partners[*place])) {
      return first + *place;
    }
    std::vector<Box> boxes;
    boxes.reserve(parts.size());
    for (const std::int32_t i : parts) boxes.push_back(boxes_[i]);
    trees.push_back(BoxTree({boxes.data(), boxes.size()}));
    made.in_order.insert(place, static_cast<std::int32_t>(made.partners.size()));
    made.partners.push_back(std::move(parts));
    return static_cast<std::int32_t>(trees.size()) - 1;
  }

  double lookahead_ = 0.0;  ///< [m]
  std::vector<Box> boxes_;  ///< [m] by PartId, while the index is built
};

}  // namespace repel::detail
