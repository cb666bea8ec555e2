// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/convex.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <support/draws.hpp>
#include <support/families.hpp>

namespace repel {
namespace convex_test {

using families::Rng;
using families::uniform;

constexpr unsigned seed = 43;

struct Sample {
  std::string name;
  Convex set;
  std::vector<Vec3> points;  ///< [m] many points of the set, including its extreme points
};

Sample box_sample(Rng& rng, const std::string& name, const Vec3& h) {
  Sample s{name, Convex::box(h), families::box(h).vertices};
  for (int i = 0; i < 500; ++i) {
    s.points.push_back(
        h.cwiseProduct(Vec3(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1))));
  }
  return s;
}

Sample cylinder_sample(const std::string& name, double radius, double half_length) {
  Sample s{name, Convex::cylinder(radius, half_length), {}};
  for (int i = 0; i < 720; ++i) {
    const double angle = i * M_PI / 360.0;
    for (const double z : {-half_length, 0.0, half_length}) {
      s.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      s.points.emplace_back(0.0, 0.0, z);
    }
  }
  return s;
}

std::vector<Vec3> directions();

Sample ellipsoid_sample(const std::string& name, const Vec3& axes) {
  Sample s{name, Convex::ellipsoid(axes), {}};
  for (const Vec3& d : directions()) {
    const Vec3 u = axes.cwiseProduct(d);
    if (u.norm() > 0.0) s.points.push_back(axes.cwiseProduct(u.normalized()));
  }
  return s;
}

std::vector<Sample> samples() {
  Rng rng(seed);
  std::vector<Sample> all;
  all.push_back(box_sample(rng, "cube", {1, 1, 1}));
  all.push_back(box_sample(rng, "brick", {0.1, 1.5, 0.7}));
  all.push_back(box_sample(rng, "rectangle", {0.4, 0.0, 0.7}));
  all.push_back(box_sample(rng, "segment", {0.0, 0.0, 0.7}));
  all.push_back(box_sample(rng, "point", {0, 0, 0}));
  all.push_back(cylinder_sample("cylinder", 0.5, 1.0));
  all.push_back(cylinder_sample("disc", 0.5, 0.0));
  all.push_back(cylinder_sample("axis", 0.0, 1.0));
  all.push_back(ellipsoid_sample("ellipsoid", {0.5, 0.2, 1.0}));
  all.push_back(ellipsoid_sample("flat ellipsoid", {1.0, 0.5, 1e-4}));
  for (const int count : {1, 2, 3, 8, 33}) {
    const std::vector<Vec3> vertices = families::cloud(rng, count, 0.9).vertices;
    all.push_back({"hull of " + std::to_string(count), Convex::polytope(vertices), vertices});
  }
  return all;
}

/// Random directions, and those along axes and edges, where support points are not unique.
std::vector<Vec3> directions() {
  Rng rng(seed);
  std::vector<Vec3> all;
  for (int i = 0; i < 500; ++i) all.push_back(families::direction(rng));
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) all.emplace_back(x, y, z);
    }
  }
  return all;
}

bool holds(const Sample& sample, const Vec3& p, double tolerance) {
  for (const Vec3& d : directions()) {
    double farthest = -1e300;
    for (const Vec3& q : sample.points) farthest = std::max(farthest, d.dot(q));
    if (d.dot(p) > farthest + tolerance) return false;
  }
  return true;
}

TEST(Convex, NoPointOfTheSetIsFartherThanTheSupportPoint) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name + ", seed " + std::to_string(seed));
    for (const Vec3& d : directions()) {
      const double support = d.dot(to_vec3(sample.set.support(Vec<double>(d)).p));
      double farthest = -1e300;
      for (const Vec3& p : sample.points) farthest = std::max(farthest, d.dot(p));
      EXPECT_GE(support, farthest - 1e-15) << d.transpose();
      // The samples of a rim are half a degree apart.
      EXPECT_LE(support, farthest + 2e-5) << d.transpose();
    }
  }
}

TEST(Convex, ExtendedPrecisionFindsTheSameSupport) {
  for (const Sample& sample : samples()) {
    for (const Vec3& d : directions()) {
      const Vec3 p = to_vec3(sample.set.support(Vec<double>(d)).p);
      const Vec3 q = to_vec3(sample.set.support(Vec<DoubleDouble>(d)).p);
      EXPECT_NEAR(d.dot(p), d.dot(q), 1e-15) << sample.name << ", " << d.transpose();
    }
  }
}

TEST(Convex, TheNameOfASupportPointBringsItBack) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name + ", seed " + std::to_string(seed));
    // The names of angles on a rim have a resolution of about 1e-8, those of nodes of 1e-4.
    const bool is_ellipsoid = sample.set.kind() == Convex::Kind::ellipsoid;
    const double tolerance = is_ellipsoid ? 1e-4 : sample.set.vertex_count() == 0 ? 1e-7 : 0.0;
    for (const Vec3& d : directions()) {
      const Convex::Point p = sample.set.support(Vec<double>(d));
      const Convex::Point again = sample.set.point(p.name);
      EXPECT_EQ(again.name, p.name);
      EXPECT_LE((to_vec3(again.p) - to_vec3(p.p)).norm(), tolerance) << d.transpose();
    }
  }
}

TEST(Convex, AnyNameGivesAPointOfTheSet) {
  Rng rng(seed);
  for (const Sample& sample : samples()) {
    std::vector<std::uint32_t> names{0U, 1U, 7U, 0xFFFFFFFFU, 0x0FFFFFFFU, 0x40000000U};
    for (int i = 0; i < families::draws(40); ++i)
      names.push_back(static_cast<std::uint32_t>(rng()));
    for (const std::uint32_t name : names) {
      const Vec3 p = to_vec3(sample.set.point(name).p);
      EXPECT_TRUE(holds(sample, p, 2e-5)) << sample.name << ", name " << name << ", seed " << seed;
      EXPECT_LE(p.norm(), sample.set.reach() * (1.0 + 1e-15)) << sample.name << ", name " << name;
    }
  }
}

TEST(Convex, NamesThatStandForOnePointBecomeOne) {
  const Convex segment = Convex::box({0.0, 0.0, 1.0});
  EXPECT_EQ(segment.point(3).name, segment.point(0).name);
  EXPECT_EQ(segment.point(7).name, segment.point(4).name);
  EXPECT_NE(segment.point(0).name, segment.point(4).name);
}

TEST(Convex, ANameSurvivesTheReductionOfItsSet) {
  const Vec3 d(0.3, -0.5, 0.8);
  const std::uint32_t corner = Convex::box({1, 2, 3}).support(Vec<double>(d)).name;
  EXPECT_EQ(to_vec3(Convex::box({0.5, 1.5, 2.5}).point(corner).p), Vec3(0.5, -1.5, 2.5));
  const std::uint32_t rim = Convex::cylinder(1, 2).support(Vec<double>(d)).name;
  const Convex smaller = Convex::cylinder(0.5, 1.5);
  const Vec3 expected = to_vec3(smaller.support(Vec<double>(d)).p);
  EXPECT_LE((to_vec3(smaller.point(rim).p) - expected).norm(), 1e-7);
  const Convex::Point oval = Convex::ellipsoid({1, 2, 3}).support(Vec<double>(d));
  const Vec3 shrunk = to_vec3(Convex::ellipsoid({0.5, 1.0, 1.5}).point(oval.name).p);
  EXPECT_LE((shrunk - 0.5 * to_vec3(oval.p)).norm(), 2e-4);
}

TEST(Convex, ReachIsTheDistanceOfTheFarthestPoint) {
  for (const Sample& sample : samples()) {
    double farthest = 0.0;
    for (const Vec3& p : sample.points) farthest = std::max(farthest, p.norm());
    EXPECT_NEAR(sample.set.reach(), farthest, 1e-15) << sample.name;
  }
}

TEST(Convex, VertexCountTellsWhatAFlatSetIs) {
  EXPECT_EQ(Convex::box({1, 2, 3}).vertex_count(), 8);
  EXPECT_EQ(Convex::box({1, 0, 3}).vertex_count(), 4);
  EXPECT_EQ(Convex::box({0, 0, 3}).vertex_count(), 2);
  EXPECT_EQ(Convex::box({0, 0, 0}).vertex_count(), 1);
  EXPECT_EQ(Convex::cylinder(1, 2).vertex_count(), 0);
  EXPECT_EQ(Convex::ellipsoid({1, 2, 3}).vertex_count(), 0);
  EXPECT_EQ(Convex::cylinder(0, 2).vertex_count(), 2);
  EXPECT_EQ(Convex::cylinder(0, 0).vertex_count(), 1);
}

TEST(Convex, OnlyACurvedSetIsNoPolytope) {
  EXPECT_TRUE(Convex::box({1, 2, 3}).is_polytope());
  EXPECT_FALSE(Convex::cylinder(1, 2).is_polytope());
  EXPECT_FALSE(Convex::ellipsoid({1, 2, 3}).is_polytope());
  EXPECT_FALSE(Convex::cylinder(1, 0).is_polytope());
  EXPECT_TRUE(Convex::cylinder(0, 2).is_polytope());
}

}  // namespace convex_test
}  // namespace repel
