// SPDX-License-Identifier: BSD-3-Clause
#include "examples/heap.hpp"

#include "support/heap_counter.hpp"

namespace repel::test {

std::int64_t heap_calls() noexcept {
  return REPEL_COUNTS_HEAP != 0 ? calls.load() : -1;
}
HeapScope::HeapScope() noexcept {
  is_counted = true;
  watched = true;
}
HeapScope::~HeapScope() {
  watched = false;
}

}  // namespace repel::test
