// SPDX-License-Identifier: BSD-3-Clause
// Counts every heap call in this program, by defining its own malloc.
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include <repel/reduction/shape.hpp>
#include "reduction/posed_boxes.hpp"
#include "support/heap_counter.hpp"

namespace repel {
namespace separation_heap_test {

using test::calls;
using test::watched;

using families::Rng;

constexpr unsigned seed = 1201;

TEST(SeparationHeap, TheCounterSeesTheHeap) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  calls = 0;
  test::is_counted = true;
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
  test::is_counted = true;
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

/// The memory of a shape after construction equals its own figure, and does not exceed the
/// announced one.
template <class Build>
void expect_announced(std::size_t announced, Build build) {
  test::blocks_held = 0;
  test::bytes_held = 0;
  watched = true;
  const Shape shape = build();
  watched = false;
  const auto blocks = static_cast<std::size_t>(test::blocks_held);
  const auto held = static_cast<std::size_t>(test::bytes_held);
  // The heap rounds a block up by less than 32 bytes.
  EXPECT_LE(held, shape.bytes() + 32 * blocks);
  EXPECT_GE(held + 64, shape.bytes());
  EXPECT_LE(shape.bytes(), announced);
}

TEST(ShapeHeap, HoldsWhatWasAnnouncedAtMost) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  test::keep_off_pages();
  Rng rng(seed);
  for (const ReductionOptions& options : {ReductionOptions{.levels = 1},
                                          {.levels = 8},
                                          {.levels = 64},
                                          {.levels = 8, .spacing = 2.0}}) {
    const std::size_t most = Shape::most_bytes(options);
    expect_announced(most, [&] { return Shape::box({0.1, 0.2, 0.3}, options); });
    expect_announced(most, [&] { return Shape::box({0.2, 0.2, 0.2}, options); });
    expect_announced(most, [&] { return Shape::sphere(0.1, options); });
    expect_announced(most, [&] { return Shape::capsule(0.1, 0.2, options); });
    expect_announced(most, [&] { return Shape::cylinder(0.1, 0.2, options); });
    expect_announced(most, [&] { return Shape::cylinder(0.2, 0.1, options); });
    expect_announced(most, [&] { return Shape::cone(0.2, 0.1, options); });
    EXPECT_LE(most, 3 * Shape::box({0.1, 0.2, 0.3}, options).bytes());
  }
}

/// Of kind 0 to 4: on a sphere, a needle, flat, a prism, two clusters of near-coincident points.
std::vector<Vec3> points_of_kind(int kind, int count, Rng& rng) {
  if (kind == 3) return families::prism(count / 2, 0.5, 0.2).vertices;
  std::vector<Vec3> points = families::cloud(rng, count, 0.5).vertices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3& p = points[i];
    if (kind == 1) p = Vec3(1e-3 * p.x(), 1e-3 * p.y(), p.z());
    if (kind == 2) p.z() = 0.0;
    if (kind == 4) p = 1e-13 * p + static_cast<double>(i % 2) * Vec3::UnitX();
  }
  return points;
}

TEST(ShapeHeap, AHullHoldsWhatWasAnnouncedAtMost) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  test::keep_off_pages();
  Rng rng(seed);
  for (const int count : {4, 5, 8, 9, 16, 31, 32, 33, 34, 50, 97, 193, 385, 769, 1100}) {
    for (const int kind : {0, 1, 2, 3, 4}) {
      if (kind == 3 && count < 6) continue;
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(count) +
                   " points of kind " + std::to_string(kind));
      const ReductionOptions options{.levels = count < 100 ? 1 + count % 16 : 1};
      const std::vector<Vec3> points = points_of_kind(kind, count, rng);
      const std::size_t most = Shape::most_bytes_of_hull(points.size(), options);
      expect_announced(most, [&] { return Shape::hull(points, options); });
      if (kind > 1) continue;
      EXPECT_LE(most, 3 * Shape::hull(points, options).bytes()) << "far too much announced";
    }
  }
}

}  // namespace separation_heap_test
}  // namespace repel
