// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The order in which near pairs are evaluated when there may not be time for all.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace repel::detail {

/// The most urgent pairs first, the others round-robin. All memory is allocated at construction.
class EvaluationOrder {
 public:
  /// @param most the largest `count` passed to `arrange`
  explicit EvaluationOrder(int most) : order_(most), chosen_(most), key_(most) {}

  /// A permutation of 0 to count - 1: first the `urgent` (at most `count`) numbers with the
  /// smallest key(i), in no particular order, then the others in cyclic order from `first`. Cost:
  /// O(count); `count` calls of `key` if `urgent` > 0.
  template <class Key>
  std::span<const std::int32_t> arrange(int count, int first, int urgent, Key&& key) noexcept {
    const auto begin = order_.begin();
    std::iota(begin, begin + count, 0);
    if (urgent > 0) {
      for (std::int32_t i = 0; i < count; ++i) key_[i] = key(i);
      std::nth_element(begin, begin + (urgent - 1), begin + count,
                       [&](std::int32_t i, std::int32_t j) { return key_[i] < key_[j]; });
      for (int k = 0; k < urgent; ++k) chosen_[order_[k]] = 1;
    }
    int placed = urgent;
    for (int k = 0; k < count; ++k) {
      const std::int32_t i = first + k < count ? first + k : first + k - count;
      if (chosen_[i] == 0) order_[placed++] = i;
      chosen_[i] = 0;
    }
    return {order_.data(), static_cast<std::size_t>(count)};
  }

 private:
  std::vector<std::int32_t> order_;
  std::vector<char> chosen_;  ///< by number: 1 for the urgent ones during `arrange`
  std::vector<double> key_;   ///< by number
};

}  // namespace repel::detail
