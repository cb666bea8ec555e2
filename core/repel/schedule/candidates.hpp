/// @file
/// The pairs that can soon come within range, in their order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/ids.hpp>

namespace repel::detail {

/// A pair and the slot of memory it has.
struct Candidate {
  PairId pair;
  std::int32_t slot = -1;
};

/// A list that is in the order of the pairs after `sort`. All memory is taken at construction.
class Candidates {
 public:
  explicit Candidates(int most) : list_(most) {}

  [[nodiscard]] std::span<const Candidate> all() const noexcept {
    return {list_.data(), static_cast<std::size_t>(count_)};
  }

  /// Not more than there is room for.
  void add(PairId pair, std::int32_t slot) noexcept { list_[count_++] = {pair, slot}; }

  /// Removes those whose slot fulfils `condition`, which is asked of each once.
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

  /// Puts what was added since into its place.
  /// Cost: for each of these a move of those behind its place.
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
  int in_order_ = 0;  ///< the first so many
};

}  // namespace repel::detail
