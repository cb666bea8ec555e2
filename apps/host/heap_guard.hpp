/// @file
/// Counts what the tick takes from the heap. The answer must be nothing.
#pragma once

#include <cstdint>

namespace repel::host {

/// While one lives, every malloc, calloc, realloc and aligned allocation of its thread is counted.
class HeapGuard {
 public:
  HeapGuard() noexcept;
  ~HeapGuard();
  HeapGuard(const HeapGuard&) = delete;
  HeapGuard& operator=(const HeapGuard&) = delete;

  /// Counts the calling thread from here to its end; for threads that do nothing but ticks.
  static void watch_this_thread() noexcept;
  /// Allocations seen under guard in the whole program; -1 where they cannot be counted (another
  /// allocator, such as a sanitizer's, is in place).
  [[nodiscard]] static std::int64_t allocations() noexcept;
};

}  // namespace repel::host
