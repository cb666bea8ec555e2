// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts the heap allocations of the tick. The count must be zero.
#pragma once

#include <cstdint>

namespace repel::host {

/// While an instance exists, every malloc, calloc, realloc and aligned allocation of its thread is
/// counted.
class HeapGuard {
 public:
  HeapGuard() noexcept;
  ~HeapGuard();
  HeapGuard(const HeapGuard&) = delete;
  HeapGuard& operator=(const HeapGuard&) = delete;

  /// Counts the allocations of the calling thread from here to its end; for threads that only run
  /// ticks.
  static void watch_this_thread() noexcept;
  /// Allocations counted in the whole program; -1 where they cannot be counted (another allocator,
  /// such as a sanitizer's, is in place).
  [[nodiscard]] static std::int64_t allocations() noexcept;
};

}  // namespace repel::host
