// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the operating system has done to a thread: page faults and involuntary switches.
#pragma once

#include <atomic>
#include <cstdint>

#if defined(__linux__)
#include <cstdio>
#endif

namespace repel::detail {

/// Counts of one thread, read by another. On Linux from /proc; elsewhere nothing is counted.
class ThreadUsage {
 public:
  struct Counts {
    std::int64_t page_faults = 0;
    std::int64_t switches = 0;  ///< taken off its processor while it had work to do
  };

  /// Call it in the thread to be watched. Opens a file.
  void attach_to_this_thread() noexcept;

  /// The counts since the thread began; of one that has not begun or has ended, those of the last
  /// call. Opens files: not for the tick.
  const Counts& look() noexcept;

 private:
#if defined(__linux__)
  template <class See>
  static void look_at(const char* file, const See& see) noexcept {
    std::FILE* const in = std::fopen(file, "re");
    if (in == nullptr) return;
    char text[1024];
    while (std::fgets(text, sizeof text, in) != nullptr) see(text);
    std::fclose(in);
  }

  std::atomic<std::int64_t> thread_{0};  ///< number by which the kernel knows it
#endif
  Counts counts_;
};

}  // namespace repel::detail
