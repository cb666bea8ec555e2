// SPDX-License-Identifier: BSD-3-Clause
// In teleop_rtsan this replaces the guard that counts heap calls of the tick: in the guarded
// sections RealtimeSanitizer aborts the program at the first call that might block.
#include <time.h>

#include <cstdlib>
#include <cstring>

#include <repel/host/heap_guard.hpp>

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer's names
extern "C" {
void __rtsan_ensure_initialized();
void __rtsan_realtime_enter();
void __rtsan_realtime_exit();
void __rtsan_disable();
void __rtsan_enable();
int __interceptor_nanosleep(const timespec* time, timespec* left);
void __interceptor_free(void* memory);
}

namespace {

thread_local bool is_worker = false;

/// A worker's sleep between ticks is not part of a tick.
struct Rest {
  Rest() noexcept { __rtsan_disable(); }
  ~Rest() { __rtsan_enable(); }
  Rest(const Rest&) = delete;
  Rest& operator=(const Rest&) = delete;
};

bool has_canary(const char* name) {
  const char* const canary = std::getenv("REPEL_RTSAN_CANARY");
  return canary != nullptr && std::strcmp(canary, name) == 0;
}

}  // namespace

extern "C" int nanosleep(const timespec* time, timespec* left) {
  if (!is_worker) return __interceptor_nanosleep(time, left);
  static const bool takes_memory = has_canary("worker");
  if (takes_memory) {
    void* volatile memory = std::malloc(1);
    std::free(memory);
  }
  const Rest rest;
  return __interceptor_nanosleep(time, left);
}
// A thread frees its own memory at its end. Other memory freed by a worker must have been allocated
// by it, which is detected.
extern "C" void free(void* memory) {
  if (!is_worker) return __interceptor_free(memory);
  const Rest rest;
  __interceptor_free(memory);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace repel::host {

HeapGuard::HeapGuard() noexcept {
  __rtsan_ensure_initialized();
  __rtsan_realtime_enter();
}
HeapGuard::~HeapGuard() {
  __rtsan_realtime_exit();
}

void HeapGuard::watch_this_thread() noexcept {
  is_worker = true;
  __rtsan_realtime_enter();
}

std::int64_t HeapGuard::allocations() noexcept {
  return -1;
}

}  // namespace repel::host
