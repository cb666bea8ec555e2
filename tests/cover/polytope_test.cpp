// SPDX-License-Identifier: BSD-3-Clause
// Convex polytopes that are cut by planes.
#include "backends/cover/polytope.hpp"

#include <gtest/gtest.h>

#include <random>

namespace repel::cover {
namespace polytope_test {

Vec3 draw(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

double volume_of(const Polytope& shape) {
  return ConvexPart::of(shape.corners(), 0.0).volume();
}

TEST(ConvexPart, OfVeryManyPointsHasFewCornersAndContainsThemAll) {
  std::mt19937_64 random(1);
  std::vector<Vec3> ball;
  for (int i = 0; i < 120'000; ++i) ball.push_back(draw(random, 1.0).normalized());
  const ConvexPart part = ConvexPart::of(ball, 0.0);
  EXPECT_LT(part.vertices.size(), 1000U);
  for (const Vec3& p : ball) ASSERT_TRUE(part.contains(p, 1e-11)) << p.transpose();
  for (const Vec3& p : part.vertices) EXPECT_LT(p.norm(), 1.05) << "reaches out far";
  EXPECT_EQ(ConvexPart::of(ball, 0.0).vertices, part.vertices);
}

TEST(ConvexPart, OfVeryManyPointsInABoxIsThatBox) {
  std::mt19937_64 random(2);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vec3> points;
  for (int i = 0; i < 120'000; ++i) points.push_back(turn * draw(random, 0.999));
  for (int i = 0; i < 8; ++i) {
    points.push_back(turn * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  EXPECT_NEAR(ConvexPart::of(points, 0.0).volume(), 8.0, 1e-6);
}

TEST(ConvexPart, OfVeryManyPointsInAPlaneHasItsThickness) {
  std::mt19937_64 random(3);
  std::vector<Vec3> points{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  for (int i = 0; i < 100'000; ++i) points.push_back(draw(random, 1.0).cwiseProduct(Vec3(1, 1, 0)));
  EXPECT_NEAR(ConvexPart::of(points, 0.1).volume(), 0.4, 1e-9);
}

TEST(Polytope, ABoxCutByPlanesKeepsItsVolume) {
  std::mt19937_64 random(1);
  int cut = 0;
  for (int i = 0; i < 200; ++i) {
    Polytope shape = Polytope::box({-1, -1, -1}, {1, 1, 1});
    double left = 8.0;
    for (int k = 0; k < 6; ++k) {
      const Vec3 n = draw(random, 1.0).normalized();
      const HalfSpace plane{n, n.dot(draw(random, 0.8))};
      const HalfSpace other{-n, -plane.offset};
      const Polytope below = shape.clipped(plane);
      const double a = below.empty() ? 0.0 : volume_of(below);
      const Polytope above = shape.clipped(other);
      const double b = above.empty() ? 0.0 : volume_of(above);
      ASSERT_NEAR(a + b, left, 1e-9) << "seed 1, sample " << i;
      if (!below.empty() && !above.empty()) ++cut;
      if (below.empty()) break;
      shape = below;
      left = a;
    }
  }
  EXPECT_GT(cut, 300);
}

TEST(Polytope, OnlyTouchedByAPlaneIsNotCut) {
  const Polytope shape = Polytope::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(shape.clipped({{1, 0, 0}, 1.0}).corners().size(), 8U);
  EXPECT_TRUE(shape.clipped({{-1, 0, 0}, -1.0}).empty());
}

TEST(ConvexPart, OfAFlatSetIsAsThickAsAskedFor) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const ConvexPart part = ConvexPart::of(square, 0.01);
  EXPECT_NEAR(part.volume(), 0.01, 1e-12);
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_TRUE(ConvexPart::of(line, 0.01).planes.empty());
}

TEST(ConvexPart, DistanceOfAPointIsThatToTheNearestFacet) {
  const ConvexPart part = ConvexPart::of(Polytope::box({0, 0, 0}, {1, 1, 1}).corners(), 0.0);
  EXPECT_EQ(part.distance({0.5, 0.2, 0.9}), 0.0);
  EXPECT_NEAR(part.distance({0.5, 0.5, 3.0}), 2.0, 1e-12);
  EXPECT_NEAR(part.distance({2, 2, 2}), std::sqrt(3.0), 1e-12);
}

}  // namespace polytope_test
}  // namespace repel::cover
