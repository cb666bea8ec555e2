// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/thread_usage.hpp>

#include <atomic>
#include <cstdio>
#include <cstring>

namespace repel::detail {

void ThreadUsage::attach_to_this_thread() noexcept {
#if defined(__linux__)
  look_at("/proc/thread-self/stat", [&](const char* line) {
    long thread = 0;
    if (std::sscanf(line, "%ld", &thread) == 1) thread_.store(thread, std::memory_order_release);
  });
#endif
}

const ThreadUsage::Counts& ThreadUsage::look() noexcept {
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

}  // namespace repel::detail
