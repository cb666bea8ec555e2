// Counts every call to the heap in this program: it brings its own malloc.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <vector>

#include "reduction/posed_boxes.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define REPEL_COUNTS_HEAP 1
#else
#define REPEL_COUNTS_HEAP 0
#endif

namespace {

std::atomic<bool> watched{false};
std::atomic<long> calls{0};

[[maybe_unused]] void count() noexcept {
  if (watched.load(std::memory_order_relaxed)) calls.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

#if REPEL_COUNTS_HEAP
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  *out = aligned_alloc(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  count();
  __libc_free(memory);
}
}
#endif

namespace repel {
namespace {

using families::Rng;

constexpr unsigned seed = 1201;

TEST(SeparationHeap, TheCounterSeesTheHeap) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  calls = 0;
  watched = true;
  int* volatile by_new = new int(1);
  delete by_new;
  void* volatile by_malloc = std::malloc(10);
  std::free(by_malloc);
  watched = false;
  EXPECT_EQ(calls, 4);
}

TEST(SeparationHeap, AQueryTakesNothingFromIt) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  Rng rng(seed);
  const std::vector<Shape> shapes{
      Shape::box({0.3, 0.4, 0.5}), Shape::sphere(0.3),
      Shape::capsule(0.1, 0.4),    Shape::cylinder(0.2, 0.5),
      Shape::box({0.5, 0, 0.5}),   Shape::hull(families::cloud(rng, 40, 0.5).vertices)};
  int overlaps = 0, total = 0;
  for (const Shape& A : shapes) {
    for (const Shape& B : shapes) {
      for (int i = 0; i < 50; ++i, ++total) {
        const test::PosedBoxes poses = test::random_boxes(rng, i % 10 == 0 ? 1e-9 : 1.5);
        WarmStart warm;
        calls = 0;
        watched = true;
        const Separation s = separation(A, poses.X_WA, B, poses.X_WB, {}, warm);
        (void)separation(A, poses.X_WA, B, poses.X_WB, {}, warm);
        (void)separation(A, poses.X_WA, B, poses.X_WB, {.iterations = 2}, warm);
        watched = false;
        ASSERT_EQ(calls, 0) << "seed " << seed << ", pair " << total;
        overlaps += s.distance < 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(overlaps, total * 2 / 10);
  EXPECT_LT(overlaps, total * 9 / 10);
}

}  // namespace
}  // namespace repel
