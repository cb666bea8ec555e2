// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/hull_ladder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <support/families.hpp>

namespace repel {
namespace hull_ladder_test {

using families::Rng;
using Points = std::vector<Vec3>;

constexpr unsigned seed = 523;

Points vertices_of(const Convex& core) {
  Points vertices;
  for (int i = 0; i < core.vertex_count(); ++i) {
    vertices.push_back(to_vec3(core.point(static_cast<std::uint32_t>(i)).p));
  }
  return vertices;
}

double farthest(const Points& points, const Vec3& n) {
  double along = -1e300;
  for (const Vec3& p : points) along = std::max(along, n.dot(p));
  return along;
}

int distinct(const Points& points) {
  std::set<std::tuple<double, double, double>> found;
  for (const Vec3& p : points) found.insert({p.x(), p.y(), p.z()});
  return static_cast<int>(found.size());
}

/// Directions that include the normals of all facets of the hull: of all triples of points if there
/// are few, which needs no hull code; otherwise of hull_facets, checked against every point.
Points directions_across(const Points& points, Rng& rng) {
  Points directions;
  for (int i = 0; i < 200; ++i) directions.push_back(families::direction(rng));
  if (points.size() > 60) {
    for (const Facet& f : hull_facets(points)) {
      EXPECT_LE(farthest(points, f.n), f.offset) << "a plane of hull_facets cuts a point off";
      directions.push_back(f.n);
    }
    return directions;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 n = (points[j] - points[i]).cross(points[k] - points[i]);
        if (!(n.norm() > 1e-30)) continue;
        directions.push_back(n.normalized());
        directions.push_back(-n.normalized());
      }
    }
  }
  return directions;
}

/// A_i+1 + Ball(t) is inside A_i if none of its support values is larger, over the facet normals of
/// A_i; a larger value along any direction disproves it.
void expect_is_a_ladder(const Ladder& ladder, const Points& points, Rng& rng) {
  ASSERT_FALSE(ladder.empty());
  double size = 0.0;
  for (const Vec3& p : points) size = std::max(size, p.norm());
  const Points corners = vertices_of(ladder.front().core);
  for (const Vec3& v : corners) {
    EXPECT_NE(std::find(points.begin(), points.end(), v), points.end()) << "a vertex made up";
  }
  for (const Vec3& n : directions_across(corners, rng)) {
    EXPECT_LE(farthest(points, n), farthest(corners, n) + 2e-15 * size) << "a corner is missing";
  }
  EXPECT_EQ(ladder.front().depth, 0.0);
  EXPECT_EQ(ladder.back().core.vertex_count(), 1) << "the last level is no point";
  for (std::size_t i = 1; i < ladder.size(); ++i) {
    SCOPED_TRACE("level " + std::to_string(i) + " of " + std::to_string(ladder.size()));
    const Points before = vertices_of(ladder[i - 1].core);
    const Points after = vertices_of(ladder[i].core);
    const double gained = ladder[i].depth - ladder[i - 1].depth;
    EXPECT_GT(ladder[i].order, ladder[i - 1].order);
    EXPECT_GE(gained, 0.0);
    EXPECT_LE(after.size(), before.size());
    EXPECT_LE(distinct(after), distinct(before));
    double outside = -1e300;
    for (const Vec3& n : directions_across(before, rng)) {
      outside = std::max(outside, farthest(after, n) + gained - farthest(before, n));
    }
    EXPECT_LE(outside, 2e-15 * size) << "the level reaches out of its parent";
  }
}

Points turned(Points points, const Mat3& R, const Vec3& by = Vec3::Zero()) {
  for (Vec3& p : points) p = R * p + by;
  return points;
}

TEST(HullLadder, RandomHullsAreNestedAsDeepAsTheyClaim) {
  Rng rng(seed);
  for (int i = 0; i < 36; ++i) {
    const int count = i < 20 ? 4 + i : families::count_between(rng, 4, 60);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", hull " + std::to_string(i) + " of " +
                 std::to_string(count) + " points");
    Points points;
    for (int k = 0; k < count; ++k) {
      points.push_back(families::uniform(rng, 0.3, 1.0) * families::direction(rng));
    }
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
    expect_is_a_ladder(ladder, points, rng);
    EXPECT_GT(ladder.back().depth, 0.0);
  }
}

TEST(HullLadder, AHullOnOneSideOfItsOriginIsNestedAsWell) {
  Rng rng(seed);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", hull " + std::to_string(i));
    const Points points =
        turned(families::cloud(rng, 12, 0.2).vertices, families::rotation(rng), Vec3(3, -2, 1));
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
    expect_is_a_ladder(ladder, points, rng);
    EXPECT_GT(ladder.back().depth, 0.0);
  }
}

TEST(HullLadder, EveryNumberOfLevelsHolds) {
  Rng rng(seed);
  const Points points = families::cloud(rng, 20, 1.0).vertices;
  for (const int levels : {1, 2, 8, 64}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(levels) + " levels");
    const Ladder ladder = detail::hull_ladder(points, {.levels = levels});
    expect_is_a_ladder(ladder, points, rng);
    EXPECT_LE(ladder.size(), 2U + static_cast<std::size_t>(levels));
    EXPECT_GE(ladder.size(), 3U);
  }
}

TEST(HullLadder, StepsAreSpacedAsAsked) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Points points = families::cloud(rng, 40, 1.0).vertices;
  const std::vector<Facet> facets = hull_facets(points);
  const double thickness = detail::depth_in(facets, detail::deep_point(facets, points));
  for (const double spacing : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    SCOPED_TRACE("spacing " + to_text(spacing));
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8, .spacing = spacing});
    expect_is_a_ladder(ladder, points, rng);
    ASSERT_EQ(ladder.size(), 10U);
    for (int i = 1; i <= 8; ++i) {
      EXPECT_NEAR(ladder[i].depth, std::pow(i / 8.0, spacing) * thickness, 0.15 * thickness);
    }
    EXPECT_NEAR(ladder[1].depth, std::pow(1 / 8.0, spacing) * thickness, 1e-6 * ladder[1].depth);
  }
}

TEST(HullLadder, TheHullOfABoxIsNearlyAsDeepAsTheBox) {
  Rng rng(seed);
  for (const Vec3& h : {Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0.5, 0.01), Vec3(0.05, 0.05, 1.0),
                        Vec3(0.3, 0.5, 0.7), Vec3(1e-3, 1e-3, 1.0)}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", extents " + std::to_string(h.x()) + " " +
                 std::to_string(h.y()) + " " + std::to_string(h.z()));
    const Points points = turned(families::box(h).vertices, families::rotation(rng));
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
    expect_is_a_ladder(ladder, points, rng);
    EXPECT_LE(ladder.back().depth, h.minCoeff());
    EXPECT_GE(ladder.back().depth, 0.8 * h.minCoeff());
  }
}

TEST(HullLadder, APlateKeepsItsWidthUntilItsThicknessIsGone) {
  const Points points = families::box({0.5, 0.5, 0.01}).vertices;
  const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
  ASSERT_GE(ladder.size(), 3U);
  const Convex& last_solid = ladder[ladder.size() - 2].core;
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
    EXPECT_GE(farthest(vertices_of(last_solid), axis), 0.45);
    EXPECT_GE(farthest(vertices_of(last_solid), -axis), 0.45);
  }
}

TEST(HullLadder, NeedlesAreNestedAsDeepAsTheyClaim) {
  Rng rng(seed);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", needle " + std::to_string(i));
    Points points = families::cloud(rng, 4 + i, 1.0).vertices;
    const double thin = families::log_uniform(rng, 1e-4, 1e-1);
    for (Vec3& p : points) p = Vec3(thin * p.x(), thin * p.y(), p.z());
    points = turned(points, families::rotation(rng));
    expect_is_a_ladder(detail::hull_ladder(points, {.levels = 8}), points, rng);
  }
}

TEST(HullLadder, ThinAndClusteredHullsAreNestedAsDeepAsTheyClaim) {
  Rng rng(seed);
  int solid = 0;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", hull " + std::to_string(i));
    Points points = families::cloud(rng, families::count_between(rng, 4, 16), 1.0).vertices;
    const double thin = families::log_uniform(rng, 1e-15, 1e-2);
    const std::size_t count = points.size();
    for (std::size_t k = 0; k < count; ++k) {
      if (i % 3 == 0) points[k].z() *= thin;
      if (i % 3 == 1) points[k] = Vec3(thin * points[k].x(), thin * points[k].y(), points[k].z());
      if (i % 3 == 2) points.push_back(points[k] + thin * families::direction(rng));
    }
    points = turned(points, families::rotation(rng));
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
    expect_is_a_ladder(ladder, points, rng);
    solid += ladder.back().depth > 0.0 ? 1 : 0;
  }
  EXPECT_GT(solid, 100);
}

TEST(HullLadder, TwoHundredPointsAreNestedAsDeepAsTheyClaim) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Points points = families::cloud(rng, 200, 1.0).vertices;
  const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
  expect_is_a_ladder(ladder, points, rng);
  EXPECT_GE(ladder.back().depth, 0.6) << "nearly a ball of radius 1";
}

TEST(HullLadder, FlatInputHasNoDepthAndEndsInAPoint) {
  Rng rng(seed);
  const Mat3 R = families::rotation(rng);
  Points plane, line;
  for (int i = 0; i < 12; ++i) {
    plane.push_back(R * Vec3(families::uniform(rng, -1, 1), families::uniform(rng, -1, 1), 0.4));
    line.push_back(R * Vec3(families::uniform(rng, -1, 1), 0.2, 0.4));
  }
  for (const Points& points : {plane, line, Points(5, Vec3(1, 2, 3)), Points{{0, 0, 0}, {1, 0, 0}},
                               Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(points.size()) + " points");
    const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
    EXPECT_EQ(ladder.size(), 2U);
    EXPECT_EQ(ladder.back().depth, 0.0);
    expect_is_a_ladder(ladder, points, rng);
  }
}

TEST(HullLadder, OnePointIsALevelOfItsOwn) {
  const Points point{{1, 2, 3}};
  const Ladder ladder = detail::hull_ladder(point, {.levels = 8});
  EXPECT_EQ(ladder.size(), 1U);
  EXPECT_EQ(ladder.front().depth, 0.0);
}

TEST(HullLadder, PointsInsideAreAllowed) {
  Rng rng(seed);
  Points points = families::box({0.5, 0.4, 0.3}).vertices;
  for (int i = 0; i < 12; ++i) points.push_back(0.2 * families::direction(rng));
  points.push_back(points.front());
  const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
  expect_is_a_ladder(ladder, points, rng);
  EXPECT_GE(ladder.back().depth, 0.8 * 0.3);
  EXPECT_EQ(ladder.front().core.vertex_count(), 8) << "a point inside is kept";
}

TEST(HullLadder, PointsThatAreNoCornersChangeNoLevel) {
  Rng rng(seed);
  const Points corners = families::cloud(rng, 30, 1.0).vertices;
  Points points = corners;
  for (int i = 0; i < 100; ++i) points.push_back(0.3 * families::direction(rng));
  points.insert(points.end(), corners.begin(), corners.end());
  const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
  const Ladder plain = detail::hull_ladder(corners, {.levels = 8});
  ASSERT_EQ(ladder.size(), plain.size());
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    EXPECT_EQ(vertices_of(ladder[i].core).size(), vertices_of(plain[i].core).size());
    // The order of the planes differs, and so do the projections onto them.
    EXPECT_NEAR(ladder[i].depth, plain[i].depth, 0.01) << "seed " << seed << ", level " << i;
  }
}

TEST(HullLadder, AVertexKeepsItsIndexFromLevelToLevel) {
  Rng rng(seed);
  for (const int count : {12, 200, 1500}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(count) + " points");
    const Ladder ladder =
        detail::hull_ladder(families::cloud(rng, count, 1.0).vertices, {.levels = 8});
    const Points before = vertices_of(ladder[0].core);
    const Points after = vertices_of(ladder[1].core);
    ASSERT_EQ(static_cast<int>(before.size()), count);
    for (std::size_t i = 0; i < after.size(); ++i) {
      EXPECT_LE((after[i] - before[i]).norm(), 5.0 * ladder[1].depth) << "vertex " << i;
    }
  }
}

TEST(HullLadder, ManyPointsOnEachFaceOfABoxAreNoObstacle) {
  Rng rng(seed);
  for (const double jitter : {0.0, 1e-16, 1e-12, 1e-9}) {
    for (const bool turn : {false, true}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", jitter " +
                   std::to_string(std::log10(jitter)));
      Points points;
      for (int i = 0; i < 343; ++i) {
        points.emplace_back(0.1 * (i % 7), 0.1 * (i / 7 % 7), 0.1 * (i / 49));
        points.back() += jitter * families::direction(rng);
      }
      if (turn) points = turned(points, families::rotation(rng));
      const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
      expect_is_a_ladder(ladder, points, rng);
      EXPECT_EQ(ladder.size(), 10U);
      EXPECT_GE(ladder.back().depth, 0.9 * 0.3);
    }
  }
}

TEST(HullLadder, TenThousandPointsAreNestedAsDeepAsTheyClaim) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Points points = families::cloud(rng, 10000, 1.0).vertices;
  const Ladder ladder = detail::hull_ladder(points, {.levels = 8});
  EXPECT_EQ(ladder.size(), 10U);
  EXPECT_EQ(ladder[0].core.vertex_count(), 10000);
  EXPECT_GE(ladder[1].core.vertex_count(), 900);
  EXPECT_LE(ladder[1].core.vertex_count(), 1014);
  EXPECT_GE(ladder.back().depth, 0.93) << "nearly a ball of radius 1";
  // Level 1 is compared with the facets of the surface, the others as for all ladders.
  const std::vector<Facet> facets = hull_facets(points);
  for (const Vec3& v : vertices_of(ladder[1].core)) {
    EXPECT_GE(detail::depth_in(facets, v), ladder[1].depth);
  }
  const Points second = vertices_of(ladder[1].core);
  Ladder inner(ladder.begin() + 1, ladder.end());
  for (Level& level : inner) level.depth -= ladder[1].depth;
  expect_is_a_ladder(inner, second, rng);
}

TEST(HullLadder, TheDeepPointIsInsideEveryPlane) {
  Rng rng(seed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", hull " + std::to_string(i));
    const Points points = families::cloud(rng, 4 + i, 1.0).vertices;
    const std::vector<Facet> facets = hull_facets(points);
    const Vec3 deep = detail::deep_point(facets, points);
    double mean_depth = 1e300;
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    for (const Facet& f : facets) {
      EXPECT_LT(f.n.dot(deep), f.offset);
      mean_depth = std::min(mean_depth, f.offset - f.n.dot(mean));
    }
    EXPECT_GE(detail::depth_in(facets, deep), mean_depth) << "the centroid is deeper";
  }
}

}  // namespace hull_ladder_test
}  // namespace repel
