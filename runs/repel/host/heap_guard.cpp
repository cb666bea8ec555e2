// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/heap_guard.hpp>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(REPEL_SANITIZED)
#define REPEL_COUNTS_HEAP 1
#else
#define REPEL_COUNTS_HEAP 0
#endif

namespace repel::host {
namespace {

// Globals, because malloc has no parameter through which to pass them.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
thread_local int guarded = 0;
std::atomic<std::int64_t> counted{0};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace

HeapGuard::HeapGuard() noexcept {
  ++guarded;
}
HeapGuard::~HeapGuard() {
  --guarded;
}

void HeapGuard::watch_this_thread() noexcept {
  ++guarded;
}

std::int64_t HeapGuard::allocations() noexcept {
  return REPEL_COUNTS_HEAP != 0 ? counted.load(std::memory_order_relaxed) : -1;
}

[[maybe_unused]] static void count() noexcept {
  if (guarded > 0) counted.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace repel::host

#if REPEL_COUNTS_HEAP
// glibc's own functions, under the names it reserves for replacements of malloc.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  repel::host::count();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  repel::host::count();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  repel::host::count();
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  repel::host::count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  *out = memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
#endif
