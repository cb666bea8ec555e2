/// @file
/// Counts the page faults and context switches of the tick. It must cause neither.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace repel::teleop {

/// Asks the kernel what the calling thread did between begin() and end(), summed over all ticks.
/// Both are system calls: for just before and just after the time that is measured.
class TickUsage {
 public:
  /// Locks what memory the program has by now, without which the kernel may take any page away.
  /// Later memory stays as it is: where little may be locked, asking for it must not fail.
  TickUsage() noexcept;

  void begin() noexcept;
  void end() noexcept;

  /// Minor and major page faults; -1 where memory cannot be locked, so that they are not the
  /// tick's.
  [[nodiscard]] std::int64_t page_faults() const noexcept;
  /// How often the thread gave up the processor.
  [[nodiscard]] std::int64_t voluntary_switches() const noexcept { return voluntary_; }
  /// How often it was taken away: the machine's, not the tick's.
  [[nodiscard]] std::int64_t involuntary_switches() const noexcept { return involuntary_; }

 private:
  bool locked_;
  rusage before_{};
  std::int64_t faults_ = 0;
  std::int64_t voluntary_ = 0;
  std::int64_t involuntary_ = 0;
};

}  // namespace repel::teleop
