// SPDX-License-Identifier: BSD-3-Clause
// What is proven of parts: which of the surface they miss, how far they reach out, how deep seams
// are. Against figures that are known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "backends/cover/coverage.hpp"
#include "backends/cover/excess.hpp"
#include "backends/cover/seams.hpp"
#include "meshes.hpp"

namespace repel::cover {
namespace bounds_test {

ConvexPart box(const Vec3& low, const Vec3& high) {
  return ConvexPart::of(Polytope::box(low, high).corners(), 0.0);
}

double area_of(const std::vector<Gap>& gaps) {
  double sum = 0.0;
  for (const Gap& gap : gaps) {
    Vec3 twice = Vec3::Zero();
    for (std::size_t i = 2; i < gap.polygon.size(); ++i) {
      twice +=
          Vec3(gap.polygon[i - 1] - gap.polygon[0]).cross(Vec3(gap.polygon[i] - gap.polygon[0]));
    }
    sum += 0.5 * twice.norm();
  }
  return sum;
}

TEST(Coverage, FindsExactlyWhatIsMissed) {
  const Solid solid(test::box_mesh({1, 1, 1}), 0.0);
  EXPECT_TRUE(gaps_in(solid.as_given(), std::vector{box({0, 0, 0}, {1, 1, 1})}, 1e-9).empty());
  // A slab of 0.1 between two parts is missed on four sides.
  const std::vector parts{box({0, 0, 0}, {0.5, 1, 1}), box({0.6, 0, 0}, {1, 1, 1})};
  const std::vector<Gap> gaps = gaps_in(solid.as_given(), parts, 1e-9);
  EXPECT_NEAR(area_of(gaps), 0.4, 1e-6);
  double deepest = 0.0;
  for (const Gap& gap : gaps) deepest = std::max(deepest, gap.depth);
  EXPECT_GE(deepest, 0.05);
  EXPECT_LE(deepest, 0.1 + 1e-9);
}

TEST(Coverage, FillsGapsThatAreNearAndKeepsThoseThatAreNot) {
  const Solid solid(test::box_mesh({1, 1, 1}), 0.0);
  std::vector parts{box({0, 0, 0}, {0.5, 1, 1}), box({0.6, 0, 0}, {1, 1, 1})};
  std::vector<ConvexPart> grown = parts;
  EXPECT_TRUE(fill_gaps(solid.as_given(), grown, 1e-9, 0.2, 1e-3).empty());
  EXPECT_FALSE(fill_gaps(solid.as_given(), parts, 1e-9, 0.01, 1e-3).empty());
}

TEST(Excess, OfTheSolidItselfIsNothing) {
  const test::Bin bin;
  const Solid solid(bin.mesh(), 0.0);
  // The five boxes that make the bin, flush with its faces.
  for (const ConvexPart& part :
       {box({0, 0, 0}, {0.2, 0.15, 0.01}), box({0, 0, 0}, {0.01, 0.15, 0.1}),
        box({0.19, 0, 0}, {0.2, 0.15, 0.1}), box({0, 0, 0}, {0.2, 0.01, 0.1}),
        box({0, 0.14, 0}, {0.2, 0.15, 0.1})}) {
    const Excess excess = excess_of(part, solid, {.gap = 1e-6});
    EXPECT_LT(excess.bound, 2e-6);
    EXPECT_LT(excess.reached, 1e-9);
  }
}

TEST(Excess, OfAHullOverABinIsTheRadiusOfItsCavity) {
  const test::Bin bin;
  const Solid solid(bin.mesh(), 0.0);
  const ConvexPart hull = box({0, 0, 0}, bin.size);
  const Excess excess = excess_of(hull, solid, {.gap = 1e-4});
  // In the middle of the mouth: 65 mm to the long walls, 90 to the bottom and to the others.
  EXPECT_NEAR(excess.bound, 0.065, 2e-4);
  EXPECT_NEAR(excess.reached, 0.065, 2e-4);
  EXPECT_LE(excess.reached, excess.bound);
  EXPECT_NEAR(bin.distance(excess.at), excess.reached, 1e-9);
}

TEST(Excess, OfAPartThatReachesOutABitIsThatBit) {
  const Solid solid(test::box_mesh({0.2, 0.15, 0.1}), 0.0);
  const Excess out = excess_of(box({0, 0, 0}, {0.2, 0.15, 0.103}), solid, {.gap = 1e-5});
  EXPECT_NEAR(out.bound, 0.003, 2e-5);
  EXPECT_LE(0.003 - 2e-5, out.reached);
}

TEST(Excess, OfAnOpenSurfaceIsMeasuredFromTheSurface) {
  TriangleMesh mesh = test::box_mesh({0.1, 0.1, 0.1});
  mesh.triangles.pop_back();
  const Solid solid(mesh, 0.0);
  EXPECT_NEAR(excess_of(box({0, 0, 0}, {0.1, 0.1, 0.1}), solid, {.gap = 1e-4}).bound, 0.05, 0.01);
}

TEST(Seams, AreAsDeepAsPartsReachIntoEachOther) {
  const Solid solid(test::box_mesh({0.2, 0.1, 0.1}), 0.0);
  for (const double overlap : {0.004, 0.01}) {
    const std::vector parts{box({0, 0, 0}, {0.1 + overlap, 0.1, 0.1}),
                            box({0.1 - overlap, 0, 0}, {0.2, 0.1, 0.1})};
    const auto depth = seam_depth(solid, parts, overlap, 20'000);
    ASSERT_TRUE(depth);
    // In the middle between both facets the depth is least.
    EXPECT_NEAR(*depth, overlap, 2e-4);
    EXPECT_GE(*depth, overlap - 1e-9);
  }
  const std::vector one{box({0, 0, 0}, {0.2, 0.1, 0.1})};
  EXPECT_FALSE(seam_depth(solid, one, 0.005, 100));
}

TEST(Seams, OfPartsThatOnlyMeetFeelNothing) {
  const Solid solid(test::box_mesh({0.2, 0.1, 0.1}), 0.0);
  const std::vector parts{box({0, 0, 0}, {0.1 + 1e-5, 0.1, 0.1}),
                          box({0.1, 0, 0}, {0.2, 0.1, 0.1})};
  const auto depth = seam_depth(solid, parts, 0.005, 20'000);
  ASSERT_TRUE(depth);
  EXPECT_LT(*depth, 2e-4);
}

TEST(Seams, GrowthReachesIntoNeighboursAndNotOutOfTheSolid) {
  const Solid solid(test::angle_mesh(0.05, 0.03), 0.0);
  // One leg of the L; it may reach 5 mm into the other, and nowhere else.
  const ConvexPart leg = box({0.05, 0, 0}, {0.2, 0.05, 0.03});
  const ConvexPart larger = grown(leg, solid, 0.005, 1e-3);
  EXPECT_NEAR(larger.low.x(), 0.045, 1e-9);
  EXPECT_NEAR(larger.high.x(), 0.2, 1e-9);
  EXPECT_LE(excess_of(larger, solid, {.gap = 1e-5}).bound, 1e-3);
}

}  // namespace bounds_test
}  // namespace repel::cover
