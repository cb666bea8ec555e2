// SPDX-License-Identifier: BSD-3-Clause
// The solid that a mesh bounds, and what is said of meshes that bound none.
#include "backends/cover/solid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include <repel/base/setup_error.hpp>

#include "meshes.hpp"

namespace repel::cover {
namespace solid_test {

TEST(Solid, OfABinHasItsWallsInsideAndItsCavityOutside) {
  const test::Bin bin;
  const Solid solid(bin.mesh(), 0.0);
  ASSERT_TRUE(solid.is_closed());
  EXPECT_TRUE(solid.faults().sentences().empty());
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-0.02, 0.22);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 p(uniform(random), uniform(random), 0.5 * uniform(random));
    ASSERT_NEAR(solid.distance(p), bin.distance(p), 1e-12) << "seed 2, sample " << i;
    if (bin.distance(p) == 0.0) ++inside;
  }
  EXPECT_GT(inside, 1000);
}

/// A ray through an edge or a corner is counted by another one.
TEST(Solid, KnowsTheInsideAlsoInLineWithItsEdges) {
  const Solid solid(test::box_mesh({2, 2, 2}), 0.0);
  for (const double x : {0.5, 1.0, 1.5}) EXPECT_TRUE(solid.has_inside({x, x, 1.0}));
  for (const double x : {-1.0, 3.0}) EXPECT_FALSE(solid.has_inside({x, x, 1.0}));
}

TEST(Solid, TurnsTrianglesThatFaceTheOtherWay) {
  TriangleMesh mesh = test::Bin().mesh();
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) {
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
  const Solid solid(mesh, 0.0);
  EXPECT_TRUE(solid.is_closed());
  EXPECT_EQ(solid.faults().turned, (mesh.triangles.size() + 4) / 5);
  EXPECT_TRUE(solid.has_inside({0.005, 0.07, 0.05}));
  EXPECT_FALSE(solid.has_inside({0.1, 0.07, 0.05}));
}

TEST(Solid, TurnsAMeshThatIsInsideOut) {
  TriangleMesh mesh = test::Bin().mesh();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const Solid solid(mesh, 0.0);
  EXPECT_TRUE(solid.faults().is_inside_out);
  EXPECT_TRUE(solid.has_inside({0.005, 0.07, 0.05}));
}

TEST(Solid, ClosesAHoleOnlyIfItIsSmall) {
  TriangleMesh mesh = test::box_mesh({0.1, 0.1, 0.1});
  mesh.triangles.pop_back();
  const Solid open(mesh, 0.01);
  EXPECT_FALSE(open.is_closed());
  EXPECT_EQ(open.faults().open_edges, 3U);
  EXPECT_FALSE(open.has_inside({0.05, 0.05, 0.05}));
  EXPECT_NEAR(open.distance({0.05, 0.05, 0.02}), 0.02, 1e-12);
  const Solid closed(mesh, 0.1);
  EXPECT_TRUE(closed.is_closed());
  EXPECT_EQ(closed.faults().closed_holes, 1U);
  EXPECT_TRUE(closed.has_inside({0.05, 0.05, 0.05}));
}

TEST(Solid, CountsDuplicatesAndTrianglesWithoutAreaOrNumbers) {
  TriangleMesh mesh = test::box_mesh({1, 1, 1});
  mesh.triangles.push_back(mesh.triangles[3]);
  mesh.triangles.push_back({0, 1, 1});
  mesh.triangles.push_back({0, 1, 99});
  mesh.vertices.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  mesh.triangles.push_back({0, 1, 8});
  const Solid solid(mesh, 0.0);
  EXPECT_EQ(solid.faults().duplicates, 1U);
  EXPECT_EQ(solid.faults().without_area, 1U);
  EXPECT_EQ(solid.faults().not_finite, 2U);
  EXPECT_TRUE(solid.is_closed());
  EXPECT_EQ(solid.faults().sentences().size(), 3U);
}

TEST(Solid, WithoutATriangleThatHasAreaIsRefused) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(Solid(mesh, 0.0), SetupError);
}

}  // namespace solid_test
}  // namespace repel::cover
