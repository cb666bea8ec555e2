// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the operating system has done to a thread: page faults and involuntary switches.
#pragma once

#include <atomic>
#include <cstdint>

#if defined(__linux__)
#include <cstdio>
#include <cstring>
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
  void attach_to_this_thread() noexcept {
#if defined(__linux__)
    look_at("/proc/thread-self/stat", [&](const char* line) {
      long thread = 0;
      if (std::sscanf(line, "%ld", &thread) == 1) thread_.store(thread, std::memory_order_release);
    });
#endif
  }

  /// The counts since the thread began; of one that has not begun or has ended, those of the last
  /// call. Opens files: not for the tick.
  const Counts& look() noexcept {
#if defined(__linux__)
    const auto thread = static_cast<long>(thread_.load(std::memory_order_acquire));
    if (thread != 0) {
      char file[64];
      std::snprintf(file, sizeof file, "/proc/self/task/%ld/stat", thread);
      look_at(file, [&](const char* line) {
        // Behind the name of the program, which is in parentheses and may contain anything.
        const char* const name_end = std::strrchr(line, ')');
        long minor = 0, major = 0;
        if (name_end != nullptr &&
            std::sscanf(name_end, ") %*c %*d %*d %*d %*d %*d %*u %ld %*u %ld", &minor, &major) == 2)
          counts_.page_faults = minor + major;
      });
      std::snprintf(file, sizeof file, "/proc/self/task/%ld/status", thread);
      look_at(file, [&](const char* line) {
        long switches = 0;
        if (std::sscanf(line, "nonvoluntary_ctxt_switches: %ld", &switches) == 1)
          counts_.switches = switches;
      });
    }
#endif
    return counts_;
  }

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
