// SPDX-License-Identifier: BSD-3-Clause
// The projection of the origin onto a simplex, compared with 113-bit arithmetic.
#include <repel/distance/simplex.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <support/families.hpp>
#include <support/oracle.hpp>

namespace repel::detail {
namespace simplex_test {

using families::Rng;

constexpr unsigned seed = 53;

template <class T>
DifferencePoint<T> point(const Vec3& w, std::uint32_t name) {
  DifferencePoint<T> p;
  p.w = p.a = Vec<T>(w);
  p.ww = dot(p.w, p.w);
  p.name_a = name;
  return p;
}

/// Three of four, or four of five, random points are on one side of the origin.
std::vector<Vec3> random_points(Rng& rng, int count) {
  const Vec3 centre = families::uniform(rng, 0.0, 1.5) * families::direction(rng);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(centre + families::uniform(rng, 0.1, 1.0) * families::direction(rng));
  }
  return points;
}

template <class T>
class SimplexOf : public ::testing::Test {};
using Precisions = ::testing::Types<double, DoubleDouble>;
TYPED_TEST_SUITE(SimplexOf, Precisions);

TYPED_TEST(SimplexOf, ProjectsTheOriginOntoItsNearestFeature) {
  Rng rng(seed);
  int enclosing = 0;
  int by_size[4] = {};
  for (int i = 0; i < 8000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "simplex", i));
    const std::vector<Vec3> points = random_points(rng, 1 + i % 4);
    const auto truth = oracle::distance(points, Pose::Identity(), {Vec3::Zero()}, Pose::Identity());
    ASSERT_TRUE(truth);
    Simplex<TypeParam> simplex;
    std::uint32_t name = 0;
    for (const Vec3& w : points) simplex.append(point<TypeParam>(w, name++));
    if (simplex.project_all(TypeParam(1e-14)) == Projection::encloses) {
      ++enclosing;
      ASSERT_TRUE(truth->distance == 0);
      continue;
    }
    ++by_size[simplex.size() - 1];
    ASSERT_NEAR(to_vec3(simplex.v()).norm(), static_cast<double>(truth->distance), 1e-14);
    Vec<TypeParam> v{};
    double sum = 0.0;
    for (int k = 0; k < simplex.size(); ++k) {
      ASSERT_GE(static_cast<double>(simplex.weight(k)), 0.0);
      sum += static_cast<double>(simplex.weight(k));
      v = v + simplex.weight(k) * simplex.point(k).w;
    }
    ASSERT_NEAR(sum, 1.0, 1e-14);
    ASSERT_LE((to_vec3(v) - to_vec3(simplex.v())).norm(), 1e-13);
  }
  EXPECT_GT(enclosing, 20);
  EXPECT_GT(by_size[0], 1000);
  EXPECT_GT(by_size[1], 200);
  EXPECT_GT(by_size[2], 100);
}

TYPED_TEST(SimplexOf, APointThatBringsNothingNearerLeavesItAsItWas) {
  Simplex<TypeParam> simplex;
  simplex.restart(point<TypeParam>({1, 0, 0}, 1));
  EXPECT_EQ(simplex.add(point<TypeParam>({2, 0, 0}, 2), TypeParam(1e-14)), Projection::no_nearer);
  EXPECT_EQ(simplex.size(), 1);
  EXPECT_EQ(to_vec3(simplex.v()), Vec3(1, 0, 0));
  EXPECT_TRUE(simplex.holds(1, 0));
  EXPECT_FALSE(simplex.holds(2, 0));
}

TYPED_TEST(SimplexOf, SurvivesPointsThatCoincideOrLieOnALine) {
  for (const Vec3& step : {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 1e-17, 0)}) {
    Simplex<TypeParam> simplex;
    for (int i = 0; i < 4; ++i) simplex.append(point<TypeParam>(Vec3(1, 0, 0) + i * step, i));
    EXPECT_EQ(simplex.project_all(TypeParam(1e-14)), Projection::nearer);
    EXPECT_EQ(to_vec3(simplex.v()), Vec3(1, 0, 0)) << step.y();
  }
}

TYPED_TEST(SimplexOf, AFlatTetrahedronEnclosesNothing) {
  Simplex<TypeParam> simplex;
  for (const Vec3& w : {Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(-1, -1, 0), Vec3(1, -1, 0)}) {
    simplex.append(point<TypeParam>(w, static_cast<std::uint32_t>(simplex.size())));
  }
  EXPECT_EQ(simplex.project_all(TypeParam(1e-14)), Projection::nearer);
  EXPECT_EQ(to_vec3(simplex.v()), Vec3(0, 0, 0));
}

TYPED_TEST(SimplexOf, AnOriginNearerToAFaceThanTheMarginIsNotEnclosed) {
  for (const double height : {1e-3, 1e-16}) {
    Simplex<TypeParam> simplex;
    for (const Vec3& w : {Vec3(1, 0, 0), Vec3(-1, 1, 0), Vec3(-1, -1, 0), Vec3(0, 0, 1)}) {
      simplex.append(
          point<TypeParam>(w - Vec3(0, 0, height), static_cast<std::uint32_t>(simplex.size())));
    }
    EXPECT_EQ(simplex.project_all(TypeParam(1e-14)),
              height > 1e-14 ? Projection::encloses : Projection::nearer)
        << height;
  }
}

}  // namespace simplex_test
}  // namespace repel::detail
