// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/quick_hull.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <support/draws.hpp>
#include <support/families.hpp>

namespace repel {
namespace quick_hull_test {

using detail::QuickHull;
using families::Rng;

constexpr unsigned seed = 67;

/// Checked exactly: no point is above any face, and neighbours agree on their common edge.
void expect_is_convex_and_closed(const std::vector<QuickHull::Face>& faces,
                                 const std::vector<Vec3>& points) {
  ASSERT_GE(faces.size(), 4U);
  int above = 0;
  std::set<int> corners;
  for (const QuickHull::Face& f : faces) {
    EXPECT_FALSE(f.gone);
    EXPECT_TRUE(f.outside.empty());
    const auto& [a, b, c] = f.vertices;
    corners.insert({a, b, c});
    for (const Vec3& p : points) {
      above += orientation(points[a], points[b], points[c], p) > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(above, 0);
  EXPECT_EQ(2 * corners.size() - 4, faces.size());
}

TEST(QuickHull, WholeNumbersGiveTheExactHull) {
  Rng rng(seed);
  int hulls = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "hull", i));
    const int range = families::count_between(rng, 1, 6);
    std::vector<Vec3> points;
    for (int k = families::count_between(rng, 4, 60); k > 0; --k) {
      points.emplace_back(families::count_between(rng, -range, range),
                          families::count_between(rng, -range, range),
                          families::count_between(rng, -range, range));
    }
    const auto faces = QuickHull(points).build();
    if (faces.empty()) continue;
    ++hulls;
    expect_is_convex_and_closed(faces, points);
  }
  EXPECT_GT(hulls, 2700);
}

TEST(QuickHull, GridsOnACubeHaveItsEightCornersOnly) {
  for (const int side : {2, 3, 6, 17}) {
    std::vector<Vec3> points;
    for (int x = 0; x < side; ++x) {
      for (int y = 0; y < side; ++y) {
        for (int z = 0; z < side; ++z) points.emplace_back(x, y, z);
      }
    }
    const auto faces = QuickHull(points).build();
    expect_is_convex_and_closed(faces, points);
    EXPECT_EQ(faces.size(), 12U);
  }
}

TEST(QuickHull, TurnedGridsAndPrismsAreConvexToTheLastBit) {
  Rng rng(seed);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "turn", i));
    std::vector<Vec3> points = families::prism(100, 1.0, 0.5).vertices;
    for (int k = 0; k < 216; ++k) points.emplace_back(k % 6, k / 6 % 6, k / 36);
    const Mat3 R = families::rotation(rng);
    for (Vec3& p : points) p = R * p;
    expect_is_convex_and_closed(QuickHull(points).build(), points);
  }
}

TEST(QuickHull, SizesFromTheTiniestToTheLargestAreAllTheSame) {
  Rng rng(seed);
  const std::vector<Vec3> unit = families::cloud(rng, 40, 1.0).vertices;
  for (const int exponent : {-1000, -300, -60, 0, 19, 300, 1000}) {
    std::vector<Vec3> points = unit;
    for (Vec3& p : points) p = Vec3(std::ldexp(1.0, exponent) * p);
    const auto faces = QuickHull(points).build();
    EXPECT_EQ(faces.size(), 76U) << "2^" << exponent;
  }
}

TEST(QuickHull, NumbersOfVeryDifferentSizeDoNotBreakIt) {
  Rng rng(seed);
  int hulls = 0;
  for (int i = 0; i < families::draws(5000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "hull", i));
    std::vector<Vec3> points;
    const auto number = [&] {
      const double x = families::log_uniform(rng, 1e-300, 1.0);
      return families::count_between(rng, 0, 1) == 0 ? -x : x;
    };
    for (int k = 0; k < 12; ++k) points.emplace_back(number(), number(), number());
    const auto faces = QuickHull(points).build();
    std::set<int> corners;
    for (const QuickHull::Face& f : faces) {
      EXPECT_NEAR(f.n.norm(), 1.0, 1e-15);
      corners.insert(f.vertices.begin(), f.vertices.end());
    }
    if (faces.empty()) continue;
    ++hulls;
    EXPECT_EQ(2 * corners.size() - 4, faces.size());
  }
  EXPECT_GT(hulls, families::draws(500));
}

}  // namespace quick_hull_test
}  // namespace repel
