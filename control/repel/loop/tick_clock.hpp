// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts the periods since the last tick.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include <repel/base/status.hpp>

namespace repel {

/// `seconds` [s], rounded.
[[nodiscard]] std::chrono::nanoseconds in_nanoseconds(double seconds) noexcept;

/// Counts the periods of a grid that starts at the first tick. A tick up to three quarters of a
/// period late counts as one period; a later one also stands for those that were missed.
class TickClock {
 public:
  using nanoseconds = std::chrono::nanoseconds;  ///< of any clock that grows, from any number on

  /// @param longest_gap longest time without a tick that is not a fault
  TickClock(nanoseconds period, nanoseconds longest_gap) noexcept
      : period_(std::max(period, nanoseconds(1))), longest_gap_(std::max(longest_gap, period_)) {}

  /// Registers the tick at `now`. @return status::clock_fault or clock_gap, or 0
  [[nodiscard]] Status step(nanoseconds now) noexcept;

  [[nodiscard]] std::int64_t elapsed() const noexcept;  ///< [periods], 1 or more

 private:
  nanoseconds period_;
  nanoseconds longest_gap_;
  nanoseconds first_{0};
  nanoseconds last_ = nanoseconds::min();
  std::int64_t index_ = 0;
  std::int64_t elapsed_ = 1;
  bool has_begun_ = false;
};

}  // namespace repel
