// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts every heap call of the program. Include it in exactly one of its files: it defines its
/// own malloc. While `repel::test::watched` is set, it counts the calls of some threads, and of all
/// threads the blocks allocated and not freed and their bytes, as rounded up by the heap.
#pragma once

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

#include <malloc.h>

#if defined(__GLIBC__) && !defined(REPEL_SANITIZED)
#define REPEL_COUNTS_HEAP 1
#else
#define REPEL_COUNTS_HEAP 0
#endif

namespace repel::test {

inline std::atomic<bool> watched{false};
inline std::atomic<long> calls{0};
/// Set it in a thread whose calls are to be counted. A thread that has not set it may still be
/// about to begin, or look after others, and is free to allocate.
inline thread_local bool is_counted = false;

inline std::atomic<long> blocks_held{0};
inline std::atomic<long> bytes_held{0};

inline void count_call() noexcept {
  if (is_counted && watched.load(std::memory_order_relaxed)) {
    calls.fetch_add(1, std::memory_order_relaxed);
  }
}
inline void* taken(void* memory, long sign = 1) noexcept {
  if (memory == nullptr || !watched.load(std::memory_order_relaxed)) return memory;
  blocks_held.fetch_add(sign, std::memory_order_relaxed);
  const long bytes = static_cast<long>(malloc_usable_size(memory));
  bytes_held.fetch_add(sign * bytes, std::memory_order_relaxed);
  return memory;
}

/// From here on no block is rounded up to whole pages.
inline void keep_off_pages() noexcept {
#if REPEL_COUNTS_HEAP
  mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace repel::test

#if REPEL_COUNTS_HEAP
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  repel::test::count_call();
  return repel::test::taken(__libc_malloc(size));
}
void* calloc(std::size_t number, std::size_t size) {
  repel::test::count_call();
  return repel::test::taken(__libc_calloc(number, size));
}
void* realloc(void* old, std::size_t size) {
  repel::test::count_call();
  repel::test::taken(old, -1);
  return repel::test::taken(__libc_realloc(old, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  repel::test::count_call();
  return repel::test::taken(__libc_memalign(alignment, size));
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  *out = aligned_alloc(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  repel::test::count_call();
  repel::test::taken(memory, -1);
  __libc_free(memory);
}
}
#endif
