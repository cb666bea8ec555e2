// Counts every call to the heap in this program: it brings its own malloc.
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "reduction/posed_boxes.hpp"
#include "support/heap_counter.hpp"

namespace repel {
namespace {

using test::calls;
using test::watched;

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
