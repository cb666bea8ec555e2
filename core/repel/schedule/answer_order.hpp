/// @file
/// In which order the near pairs of a tick are answered when there may not be time for all.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace repel::detail {

/// The most urgent first, the rest in turn. All memory is taken at construction.
class AnswerOrder {
 public:
  /// @param most that are ever put in order
  explicit AnswerOrder(int most) : order_(most), chosen_(most), key_(most) {}

  /// The numbers 0 to count - 1: first those `urgent` (at most `count`) of the least key(i), then
  /// the others from `first` on and round.
  /// Cost: `count` keys, and time in proportion to `count`.
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
  std::vector<char> chosen_;  ///< by number: 1 for the urgent, while they are put in order
  std::vector<double> key_;   ///< by number
};

}  // namespace repel::detail
