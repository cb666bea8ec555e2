// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts what the calling thread takes from the heap in a scope; support/heap_counter.hpp is in
/// one of the sources of the suite.
#pragma once

#include <cstdint>

namespace repel::test {

/// Calls of the heap counted so far, or -1 where they cannot be counted.
std::int64_t heap_calls() noexcept;

/// While one exists, the heap calls of its thread are counted.
class HeapScope {
 public:
  HeapScope() noexcept;
  ~HeapScope();
  HeapScope(const HeapScope&) = delete;
  HeapScope& operator=(const HeapScope&) = delete;
};

}  // namespace repel::test
