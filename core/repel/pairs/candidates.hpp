// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The list of the pairs of a world that can soon come within range: the broad-phase result.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/ids.hpp>

namespace repel::detail {

/// A pair and its slot in the PairMemory.
struct Candidate {
  /// [m] summed travel of both bodies below which the pair cannot be within range, or less
  double due_at = -std::numeric_limits<double>::infinity();
  PairId pair;
  std::int32_t slot = -1;
  std::int32_t list = -1;  ///< the neighbour list of the pair; all its pairs are of two bodies

  /// Ascends in the order of the candidates.
  [[nodiscard]] std::int64_t key() const noexcept {
    return std::int64_t{list} << 32U | std::int64_t{pair.index};
  }
};

/// Candidates, sorted by list and, within a list, by pair. So a change of one list costs no look at
/// the others. All memory is allocated at construction.
class Candidates {
 public:
  explicit Candidates(int most) : all_(most) {}

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] const Candidate& operator[](int i) const noexcept { return all_[i]; }
  [[nodiscard]] Candidate* begin() noexcept { return all_.data(); }
  [[nodiscard]] const Candidate* begin() const noexcept { return all_.data(); }
  [[nodiscard]] Candidate* end() noexcept { return all_.data() + count_; }
  [[nodiscard]] const Candidate* end() const noexcept { return all_.data() + count_; }

  /// Adds a pair, which is not in order before the next `update` of its list. Precondition: fewer
  /// than `most` are stored.
  void add(PairId pair, std::int32_t slot, std::int32_t list) noexcept {
    all_[count_++] = {.pair = pair, .slot = slot, .list = list};
  }

  /// Removes those candidates of a list for which `condition(slot)` is true; it is called once for
  /// each. Sorts in those added since the last call, which are all of this list.
  /// Cost: apart from these, one move of all candidates behind, if their number changes.
  template <class Condition>
  void update(std::int32_t list, const Condition& condition) noexcept {
    const auto is_gone = [&](const Candidate& c) { return condition(c.slot); };
    const auto [begin, end] = places_of(list);
    const auto kept_end = std::remove_if(begin, end, is_gone);
    const auto added_end = std::remove_if(added(), all_.begin() + count_, is_gone);
    close(begin, kept_end, end, added_end);
  }

  void clear() noexcept { count_ = in_order_ = 0; }

 private:
  using Place = std::vector<Candidate>::iterator;
  struct Places {
    Place begin, end;
  };

  /// Where those begin that are not in order.
  [[nodiscard]] Place added() noexcept { return all_.begin() + in_order_; }

  /// Those of a list that are in order.
  [[nodiscard]] Places places_of(std::int32_t list) noexcept {
    const auto begin = std::partition_point(all_.begin(), added(),
                                            [&](const Candidate& c) { return c.list < list; });
    const auto end =
        std::partition_point(begin, added(), [&](const Candidate& c) { return c.list == list; });
    return {begin, end};
  }

  /// Closes the gap [kept_end, end) in a list that begins at `begin`, and sorts in those added.
  void close(Place begin, Place kept_end, Place end, Place added_end) noexcept {
    const Place first_added = added();
    count_ = in_order_ = static_cast<int>(added_end - all_.begin() - (end - kept_end));
    // Behind the kept: a gap, the candidates of other lists, the added.
    const auto others = std::rotate(end, first_added, added_end);
    if (kept_end != end) std::move(end, added_end, kept_end);
    merge(begin, kept_end, kept_end + (others - end));
  }

  /// Sorts [middle, end), in any order, into [begin, middle), by insertion.
  static void merge(Place begin, Place middle, Place end) noexcept {
    const auto is_before = [](const Candidate& a, const Candidate& b) {
      return a.pair.index < b.pair.index;
    };
    std::sort(middle, end, is_before);
    for (; middle != end; ++middle) {
      const auto place = std::upper_bound(begin, middle, *middle, is_before);
      std::rotate(place, middle, middle + 1);
    }
  }

  std::vector<Candidate> all_;
  int count_ = 0;
  int in_order_ = 0;  ///< length of the sorted prefix
};

}  // namespace repel::detail
