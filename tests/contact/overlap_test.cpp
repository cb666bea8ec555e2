// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/overlap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <support/families.hpp>

namespace repel {
namespace overlap_test {

using namespace detail;

Outline square(double half, bool of_a) {
  Outline outline;
  outline.add({-half, -half}, of_a);
  outline.add({half, -half}, of_a);
  outline.add({half, half}, of_a);
  outline.add({-half, half}, of_a);
  return outline;
}

double area_of(const Outline& outline) {
  double twice = 0.0;
  for (int i = 0; i < outline.size; ++i) twice += cross(outline.at(i).r, outline.after(i).r);
  return 0.5 * twice;
}

TEST(Cut, LeavesWhatIsInsideAndTellsWhoseEachSideIs) {
  const Outline whole = square(1.0, true);
  Outline outline;
  ASSERT_TRUE(cut(whole, {3.0, 0.0}, 1.5, false, outline));
  EXPECT_NEAR(area_of(outline), 3.0, 1e-15);
  int others = 0;
  for (int i = 0; i < outline.size; ++i) {
    if (outline.at(i).of_a) continue;
    ++others;
    EXPECT_EQ(outline.at(i).r.x, 0.5);
    EXPECT_EQ(outline.after(i).r.x, 0.5);
  }
  EXPECT_EQ(others, 1);
  EXPECT_FALSE(cut(whole, {1.0, 0.0}, 2.0, false, outline));
  EXPECT_EQ(outline.size, 4);
  EXPECT_TRUE(cut(whole, {1.0, 0.0}, -3.0, false, outline));
  EXPECT_EQ(outline.size, 0);
}

TEST(Cut, OfASegmentMovesItsEnd) {
  Outline segment;
  segment.add({-1.0, 0.0}, true);
  segment.add({1.0, 0.0}, true);
  cut_segment(segment, {1.0, 0.0}, 0.25, false);
  ASSERT_EQ(segment.size, 2);
  EXPECT_EQ(segment.at(1).r.x, 0.25);
  EXPECT_FALSE(segment.at(1).of_a);
  EXPECT_TRUE(segment.at(0).of_a);
}

Outline rectangle(double half_x, double half_y, double angle, const Planar& centre, bool of_a) {
  const Planar u = half_x * Planar{std::cos(angle), std::sin(angle)};
  const Planar v = half_y * Planar{-std::sin(angle), std::cos(angle)};
  Outline outline;
  for (const Planar& corner : {-1.0 * u - v, u - v, u + v, v - u}) {
    outline.add(centre + corner, of_a);
  }
  return outline;
}

// The overlap has the area that counting points of both gives.
TEST(Overlap, OfRectanglesHasTheirCommonArea) {
  constexpr unsigned seed = 5;
  families::Rng rng(seed);
  int overlapping = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const auto u = [&](double low, double high) { return families::uniform(rng, low, high); };
    const Outline a = rectangle(u(0.2, 1.0), u(0.2, 1.0), u(-3.0, 3.0), {0.0, 0.0}, true);
    const Outline b = rectangle(u(0.2, 1.0), u(0.2, 1.0), u(-3.0, 3.0), {u(-1.0, 1.0), 0.3}, false);
    Outline outline;
    Sides sides;
    const bool found = find_overlap(a, b, false, outline, sides);
    const auto has = [](const Outline& rect, double x, double y) {
      bool inside = true;
      for (int k = 0; k < 4; ++k) {
        const Planar from = rect.at(k).r;
        inside = inside && cross(rect.after(k).r - from, Planar{x, y} - from) >= 0.0;
      }
      return inside;
    };
    int both = 0;
    constexpr int grid = 150;
    for (int k = 0; k < grid * grid; ++k) {
      const double x = -1.5 + 3.0 * (k % grid + 0.5) / grid;
      const double y = -1.5 + 3.0 * (k / grid + 0.5) / grid;
      both += has(a, x, y) && has(b, x, y) ? 1 : 0;
    }
    EXPECT_NEAR(found ? std::abs(area_of(outline)) : 0.0, both * 9.0 / (grid * grid), 0.05);
    overlapping += both > 0 ? 1 : 0;
  }
  EXPECT_GT(overlapping, 100);
}

TEST(Overlap, OfTwoSegmentsLiesAlongTheirBisector) {
  Outline a;
  a.add({-1.0, -0.1}, true);
  a.add({1.0, 0.1}, true);
  Outline b;
  b.add({0.5, -0.05}, false);
  b.add({-2.0, 0.2}, false);
  Outline outline;
  Sides sides;
  ASSERT_TRUE(find_overlap(a, b, true, outline, sides));
  ASSERT_EQ(outline.size, 2);
  const double first = norm(outline.at(0).r);
  const double last = norm(outline.at(1).r);
  EXPECT_NEAR(std::max(first, last), 1.0, 0.01);
  EXPECT_NEAR(std::min(first, last), 0.5, 0.01);
  // Each ends where the shorter one does.
  for (int i = 0; i < 2; ++i) EXPECT_EQ(outline.at(i).of_a, norm(outline.at(i).r) > 0.7);
}

}  // namespace overlap_test
}  // namespace repel
