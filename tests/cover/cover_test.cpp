// SPDX-License-Identifier: BSD-3-Clause
// Covers as a whole, checked by means that have no part in making them: GJK of the core, and
// distances that are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <repel/base/setup_error.hpp>
#include <repel/cover/cover.hpp>
#include <repel/force/law.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

#include "meshes.hpp"

namespace repel::cover {
namespace cover_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Points of the surface, as many in each area.
std::vector<Vec3> points_on(const TriangleMesh& mesh, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> sums;
  double sum = 0.0;
  const auto corner = [&](std::size_t t, int i) { return mesh.vertices[mesh.triangles[t][i]]; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sum += Vec3(corner(t, 1) - corner(t, 0)).cross(Vec3(corner(t, 2) - corner(t, 0))).norm();
    sums.push_back(sum);
  }
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const auto at = std::lower_bound(sums.begin(), sums.end(), uniform(random) * sum);
    const auto t = static_cast<std::size_t>(at - sums.begin());
    const double root = std::sqrt(uniform(random));
    const double b = uniform(random);
    points.push_back((1.0 - root) * corner(t, 0) + (root * (1.0 - b)) * corner(t, 1) +
                     (root * b) * corner(t, 2));
  }
  return points;
}

double distance_from(const std::vector<Shape>& parts, const Vec3& p) {
  const Shape point = Shape::sphere(0.0);
  Pose X = Pose::Identity();
  X.translation() = p;
  double least = infinity;
  for (const Shape& part : parts) {
    least = std::min(least, std::max(0.0, separation(part, Pose::Identity(), point, X).distance));
  }
  return least;
}

void expect_covered(const TriangleMesh& mesh, const Cover& cover) {
  std::vector<Shape> shapes;
  for (const auto& part : cover.parts) shapes.push_back(Shape::hull(part));
  double farthest = 0.0;
  for (const Vec3& p : points_on(mesh, 20'000, 3)) {
    farthest = std::max(farthest, distance_from(shapes, p));
  }
  EXPECT_LE(farthest, cover.uncovered_m) << "seed 3";
}

/// Points of a part: means of its corners.
std::vector<Vec3> points_in(const std::vector<Vec3>& part, int count, std::mt19937_64& random) {
  std::exponential_distribution<double> weight(1.0);
  std::vector<Vec3> points(part);
  for (int k = 0; k < count; ++k) {
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (const Vec3& p : part) {
      // Large powers make most points lie near corners, edges and facets.
      const double w = std::pow(weight(random), 4.0);
      sum += w * p;
      total += w;
    }
    points.push_back(sum / total);
  }
  return points;
}

TEST(Cover, OfABinLeavesItsCavityOpen) {
  const test::Bin bin;
  const Cover cover = cover_of(bin.mesh(), {.parts = 16, .error = 1e-3, .overlap = 5e-3});
  EXPECT_TRUE(cover.uncovered.empty());
  EXPECT_LE(cover.parts.size(), 8U);
  EXPECT_GE(cover.parts.size(), 5U);
  EXPECT_LE(cover.excess_m, 1.1e-3);
  EXPECT_LE(cover.excess_reached_m, cover.excess_m);
  ASSERT_TRUE(cover.seam_m);
  EXPECT_GE(*cover.seam_m, 2e-3);
  expect_covered(bin.mesh(), cover);
  std::mt19937_64 random(4);
  double farthest = 0.0;
  for (const auto& part : cover.parts) {
    for (const Vec3& p : points_in(part, 5'000, random)) {
      farthest = std::max(farthest, bin.distance(p));
    }
  }
  EXPECT_LE(farthest, cover.excess_m) << "seed 4";
}

TEST(Cover, OfAConvexMeshIsItsHull) {
  const Cover cover = cover_of(test::box_mesh({0.1, 0.2, 0.3}), {});
  ASSERT_EQ(cover.parts.size(), 1U);
  EXPECT_EQ(cover.parts[0].size(), 8U);
  EXPECT_LT(cover.excess_m, 1e-4);
  EXPECT_FALSE(cover.seam_m);
}

TEST(Cover, OfARingKeepsItsHoleOpen) {
  const TriangleMesh ring = test::ring_mesh(32);
  const Cover cover = cover_of(ring, {.parts = 24, .error = 2e-3, .overlap = 2e-3});
  EXPECT_TRUE(cover.uncovered.empty());
  EXPECT_LE(cover.excess_m, 2.2e-3);
  expect_covered(ring, cover);
}

TEST(Cover, ByHacdMissesNothingOfABinAndAnAngle) {
  if (!has_hacd()) GTEST_SKIP() << "built without HACD (libbullet-extras-dev)";
  const test::Bin bin;
  const TriangleMesh angle = test::angle_mesh(0.02, 0.05);
  for (const TriangleMesh& mesh : {bin.mesh(), angle}) {
    const CoverOptions options{.parts = 16, .error = 2e-3, .engine = Engine::hacd};
    const Cover cover = cover_of(mesh, options);
    EXPECT_EQ(cover.engine, "hacd");
    EXPECT_TRUE(cover.uncovered.empty());
    EXPECT_LE(cover.parts.size(), 16U);
    EXPECT_LE(cover.excess_reached_m, cover.excess_m);
    expect_covered(mesh, cover);
    const Cover again = checked_cover(mesh, cover.parts, options);
    EXPECT_TRUE(again.uncovered.empty());
    EXPECT_NEAR(again.excess_m, cover.excess_m, 0.1 * options.error);
  }
}

TEST(Cover, ByHacdWithoutItNamesItsPackage) {
  if (has_hacd()) GTEST_SKIP() << "built with HACD";
  try {
    (void)cover_of(test::box_mesh({1, 1, 1}), {.engine = Engine::hacd});
    FAIL() << "not refused";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install libbullet-extras-dev"),
              std::string::npos);
  }
}

TEST(Cover, WithTooFewPartsSaysHowFarTheyReachOut) {
  const test::Bin bin;
  const Cover cover = cover_of(bin.mesh(), {.parts = 1, .error = 1e-3});
  ASSERT_EQ(cover.parts.size(), 1U);
  EXPECT_NEAR(cover.excess_m, 0.065, 2e-4);
}

TEST(Cover, OfAnOpenSheetIsThinAndSaysSo) {
  TriangleMesh sheet;
  test::add_quad(sheet, {0, 0, 0}, {0.2, 0, 0}, {0.2, 0.1, 0}, {0, 0.1, 0});
  const Cover cover = cover_of(sheet, {.error = 1e-3});
  EXPECT_FALSE(cover.is_closed);
  ASSERT_EQ(cover.faults.size(), 1U);
  EXPECT_NE(cover.faults[0].find("open"), std::string::npos);
  EXPECT_TRUE(cover.uncovered.empty());
  EXPECT_LE(cover.excess_m, 1e-3);
}

TEST(Cover, OfGivenPartsListsWhatTheyMiss) {
  const TriangleMesh mesh = test::box_mesh({1, 1, 1});
  const std::vector<Vec3> half{{0, 0, 0}, {0.5, 0, 0}, {0, 1, 0}, {0.5, 1, 0},
                               {0, 0, 1}, {0.5, 0, 1}, {0, 1, 1}, {0.5, 1, 1}};
  const Cover cover = checked_cover(mesh, {half}, {});
  EXPECT_FALSE(cover.uncovered.empty());
  EXPECT_NEAR(cover.uncovered_m, 0.5, 1e-6);
}

TEST(Cover, RefusesOptionsOutOfTheirRange) {
  const TriangleMesh mesh = test::box_mesh({1, 1, 1});
  EXPECT_THROW((void)cover_of(mesh, {.parts = 0}), SetupError);
  EXPECT_THROW((void)cover_of(mesh, {.error = 0.0}), SetupError);
  EXPECT_THROW((void)cover_of(mesh, {.overlap = std::nan("")}), SetupError);
}

// Corners 1e20 m away, as a damaged file has them, ended the program.
TEST(Cover, RefusesMeshesThatNoShapeCanBeOf) {
  TriangleMesh mesh = test::box_mesh({1, 1, 1});
  const Vec3 corner = mesh.vertices[0];
  for (const double far : {1e20, -1e300, std::nan("")}) {
    mesh.vertices[0].x() = far;
    EXPECT_THROW((void)cover_of(mesh, {.parts = 1}), SetupError) << far;
    EXPECT_THROW((void)checked_cover(mesh, {}, {}), SetupError) << far;
  }
  mesh.vertices[0] = corner;
  for (const int vertex : {-1, static_cast<int>(mesh.vertices.size())}) {
    mesh.triangles[0][1] = vertex;
    EXPECT_THROW((void)cover_of(mesh, {.parts = 1}), SetupError) << vertex;
  }
}

/// The force [N] on a ball by the law of a wall between it and each part.
Vec3 force_on(const Shape& ball, const Vec3& centre, const std::vector<Shape>& parts,
              const ForceLaw& law) {
  Vec3 sum = Vec3::Zero();
  for (const Shape& part : parts) {
    const Separation s = separation(ball, Pose(Eigen::Translation3d(centre)), part,
                                    Pose::Identity(), {.measure = Measure::exact});
    sum += law.spring(s.distance) * s.extraction_W;
  }
  return sum;
}

// What the parts of a mesh do together changes along a way no faster than each of them does alone,
// times how many are in reach: at a seam no force appears at once.
TEST(Cover, IsFeltWithoutJumpsWhereItsPartsMeet) {
  const ForceLaw law{.range = 0.02, .surface_force = 50.0};
  const test::Bin bin;
  const Cover cover = cover_of(bin.mesh(), {.parts = 8, .error = 2e-3, .overlap = 5e-3});
  ASSERT_GT(cover.parts.size(), 3U) << "seams to sweep over";
  std::vector<Shape> parts;
  for (const auto& part : cover.parts) parts.push_back(Shape::hull(part, {.levels = 1}));
  const Shape ball = Shape::sphere(5e-3, {.levels = 1});
  constexpr double step = 1e-4;  // [m]
  double largest_step = 0.0;
  double largest = 0.0;
  const auto sweep = [&](const Vec3& from, const Vec3& to) {
    const int steps = static_cast<int>((to - from).norm() / step);
    Vec3 last = force_on(ball, from, parts, law);
    for (int i = 1; i <= steps; ++i) {
      const Vec3 now =
          force_on(ball, from + static_cast<double>(i) / steps * (to - from), parts, law);
      largest_step = std::max(largest_step, (now - last).norm());
      largest = std::max(largest, now.norm());
      last = now;
    }
  };
  // Over the bottom from wall to wall, up a corner, around the rim, and along the outside.
  for (const double height : {0.005, 0.001}) {
    const double z = 0.01 + 5e-3 + height;
    sweep({0.02, 0.075, z}, {0.18, 0.075, z});
    sweep({0.1, 0.02, z}, {0.1, 0.13, z});
    sweep({0.02, 0.02, z}, {0.02, 0.02, 0.12});
    sweep({-0.005 - height, 0.01, 0.05}, {-0.005 - height, 0.14, 0.05});
    sweep({-0.01, 0.005, 0.105 + height}, {0.21, 0.005, 0.105 + height});
  }
  EXPECT_GT(largest, 40.0);
  const double most = law.stiffness() * step * static_cast<double>(parts.size());
  EXPECT_LT(largest_step, most);
  // Of all that are there, three at most meet in one place.
  EXPECT_LT(largest_step, 3.0 * law.stiffness() * step + 1e-9);
}

}  // namespace cover_test
}  // namespace repel::cover
