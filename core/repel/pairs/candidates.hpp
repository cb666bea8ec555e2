/// @file
/// The list of the pairs of a world that can soon come within range: the broad-phase result.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/ids.hpp>

namespace repel::detail {

/// A pair and its slot in the PairMemory.
struct Candidate {
  PairId pair;
  std::int32_t slot = -1;
};

/// Candidates, sorted by pair id after `sort`. All memory is allocated at construction.
class Candidates {
 public:
  explicit Candidates(int most) : list_(most) {}

  [[nodiscard]] std::span<const Candidate> all() const noexcept {
    return {list_.data(), static_cast<std::size_t>(count_)};
  }

  /// Appends a pair. Precondition: fewer than `most` are stored.
  void add(PairId pair, std::int32_t slot) noexcept { list_[count_++] = {pair, slot}; }

  /// Removes the candidates for whose slot `condition` is true; it is called once for each.
  template <class Condition>
  void remove_if(Condition&& condition) noexcept {
    int kept = 0;
    int kept_in_order = 0;
    for (int i = 0; i < count_; ++i) {
      if (condition(list_[i].slot)) continue;
      kept_in_order += i < in_order_ ? 1 : 0;
      list_[kept++] = list_[i];
    }
    count_ = kept;
    in_order_ = kept_in_order;
  }

  /// Sorts in the candidates added since the last call, by insertion.
  /// Cost: for each of these, one move of all candidates behind it.
  void sort() noexcept {
    for (; in_order_ < count_; ++in_order_) {
      const Candidate added = list_[in_order_];
      const auto end = list_.begin() + in_order_;
      const auto place = std::upper_bound(
          list_.begin(), end, added,
          [](const Candidate& a, const Candidate& b) { return a.pair.index < b.pair.index; });
      std::move_backward(place, end, end + 1);
      *place = added;
    }
  }

 private:
  std::vector<Candidate> list_;
  int count_ = 0;
  int in_order_ = 0;  ///< length of the sorted prefix
};

}  // namespace repel::detail
