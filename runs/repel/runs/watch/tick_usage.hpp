// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts the page faults and context switches of the tick. Both counts should be zero.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace repel::runs {

/// Reads the kernel's counters of the calling thread at begin() and end(), and sums the differences
/// over all ticks. Both make a system call: call them just before and just after the measured time.
class TickUsage {
 public:
  /// Touches the stack of the ticks, and locks all present memory of the program; otherwise the
  /// kernel may evict any page. Memory allocated later is not locked: where the limit is low,
  /// allocating it must not fail.
  /// @param lock false: nothing is touched and locked, and page faults are not counted
  explicit TickUsage(bool lock) noexcept;

  void begin() noexcept;
  void end() noexcept;

  /// Minor and major page faults; -1 if memory could not be locked, since faults then need not be
  /// caused by the tick.
  [[nodiscard]] std::int64_t page_faults() const noexcept;
  /// How often the thread yielded the processor.
  [[nodiscard]] std::int64_t voluntary_switches() const noexcept { return voluntary_; }
  /// How often it was preempted: caused by the machine, not by the tick.
  [[nodiscard]] std::int64_t involuntary_switches() const noexcept { return involuntary_; }

 private:
  bool locked_;
  rusage before_{};
  std::int64_t faults_ = 0;
  std::int64_t voluntary_ = 0;
  std::int64_t involuntary_ = 0;
};

}  // namespace repel::runs
