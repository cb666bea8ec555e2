// SPDX-License-Identifier: BSD-3-Clause
// The oracles compared with each other: pairs of features, Wolfe's algorithm and separating axes
// share only the 113-bit arithmetic. Their common results are the references of the other tests.
#include <support/oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <support/exact_depth.hpp>
#include <support/gaps.hpp>

namespace repel {
namespace oracle_test {

using families::Pair;
using families::Rng;
using oracle::Polytope;
using oracle::Real;

constexpr unsigned seed = 1976;

std::string nth(const std::string& family, int i) {
  return family + ", seed " + std::to_string(seed) + ", pair " + std::to_string(i);
}

/// A pair with its features.
struct Featured {
  Pair p;
  Polytope A, B;
  explicit Featured(const Pair& pair) : p(pair), A(pair.A.vertices), B(pair.B.vertices) {}

  [[nodiscard]] std::optional<oracle::Truth> by_features() const {
    return oracle::Features(A, p.X_WA, B, p.X_WB).nearest_of_best();
  }
  [[nodiscard]] std::optional<oracle::Truth> by_wolfe() const {
    oracle::PlacedPair pair(A.vertices(), p.X_WA, B.vertices(), p.X_WB);
    return oracle::distance_by_wolfe(pair);
  }
  [[nodiscard]] Real depth() const { return oracle::penetration_depth(A, p.X_WA, B, p.X_WB); }
};

TEST(Oracle, FeaturesAndWolfeAgreeOnTheGap) {
  Rng rng(seed);
  int by_features = 0;
  int pairs = 0;
  for (const std::string& family : families::names()) {
    for (int i = 0; i < 120; ++i) {
      SCOPED_TRACE(nth(family, i));
      const Featured pair(families::draw_apart(family, rng, families::log_uniform(rng, 1e-9, 1.0)));
      const auto features = pair.by_features();
      const auto wolfe = pair.by_wolfe();
      ASSERT_TRUE(wolfe);
      ++pairs;
      if (!features) continue;
      ++by_features;
      const Real off = oracle::magnitude(features->distance - wolfe->distance);
      EXPECT_LE(static_cast<double>(off), 1e-20 * families::size(pair.p));
    }
  }
  // The rest may use the fallback, but the fast method must be the rule.
  EXPECT_GT(by_features, pairs * 99 / 100);
}

TEST(Oracle, NoPairOfFeaturesIsProvenNearestInOverlap) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(nth("overlap", i));
    const Featured pair(families::draw_overlapping(families::names()[i % 12], rng, 0.01));
    EXPECT_FALSE(pair.by_features());
    const auto wolfe = pair.by_wolfe();
    ASSERT_TRUE(wolfe);
    EXPECT_EQ(static_cast<double>(wolfe->distance), 0.0);
  }
}

// Translated by its depth along the right axis, a pair touches; translated by less along any axis,
// it still overlaps.
TEST(Oracle, TheDepthIsTheShortestWayOut) {
  Rng rng(seed);
  int solid = 0;
  for (int i = 0; i < 600; ++i) {
    const std::string family = families::names()[i % 12];
    SCOPED_TRACE(nth(family, i));
    Featured pair(families::draw_overlapping(family, rng, families::log_uniform(rng, 1e-6, 0.1)));
    if (!pair.A.closed() || !pair.B.closed()) continue;
    ++solid;
    const double depth = static_cast<double>(pair.depth());
    ASSERT_GT(depth, 0.0);
    for (int k = 0; k < 4; ++k) {
      Featured moved = pair;
      moved.p.X_WB.translation() += 0.999 * depth * families::direction(rng);
      EXPECT_GT(static_cast<double>(moved.depth()), 0.0);
      const auto wolfe = moved.by_wolfe();
      ASSERT_TRUE(wolfe);
      EXPECT_EQ(static_cast<double>(wolfe->distance), 0.0);
    }
  }
  EXPECT_EQ(solid, 600);
}

TEST(Oracle, SeparatedPairsHaveNoDepth) {
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    const std::string family = families::names()[i % 12];
    SCOPED_TRACE(nth(family, i));
    const Featured pair(families::draw_apart(family, rng, 1e-6));
    const double separated = -static_cast<double>(pair.depth());
    EXPECT_GT(separated, 0.0);
    EXPECT_LE(separated, 1.001e-6 + 1e-15 * pair.p.X_WB.translation().norm());
  }
}

TEST(Oracle, ABoxHasTwelveEdgesAlongThreeDirections) {
  const Polytope box(families::box({1.0, 2.0, 0.001}).vertices);
  EXPECT_EQ(box.faces().size(), 6U);
  EXPECT_EQ(box.edges().size(), 12U);
  EXPECT_EQ(box.directions().size(), 3U);
  EXPECT_TRUE(box.closed());
  EXPECT_DOUBLE_EQ(box.outside_by({1.5, 0.0, 0.0}), 0.5);
}

TEST(Oracle, ClosesHullsWithPointsInsideOnFacesAndTwice) {
  std::vector<Vec3> points = families::box({1.0, 1.0, 1.0}).vertices;
  for (const Vec3& extra : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0.25), Vec3(1, 1, 1)}) {
    points.push_back(extra);
  }
  const Polytope box(points);
  EXPECT_EQ(box.vertices().size(), 11U);
  EXPECT_EQ(box.faces().size(), 6U);
  EXPECT_EQ(box.edges().size(), 12U);
  EXPECT_TRUE(box.closed());
}

TEST(Oracle, FlatAndThinPointsHaveTheirFeatures) {
  const Polytope rectangle(families::box({1.0, 2.0, 0.0}).vertices);
  EXPECT_EQ(rectangle.faces().size(), 2U);
  EXPECT_EQ(rectangle.edges().size(), 4U);
  const Polytope segment(families::box({0.0, 2.0, 0.0}).vertices);
  EXPECT_TRUE(segment.faces().empty());
  EXPECT_EQ(segment.edges().size(), 1U);
  const Polytope point(std::vector<Vec3>{{1.0, 2.0, 3.0}});
  EXPECT_TRUE(point.edges().empty());
}

TEST(Oracle, RandomHullsAndPrismsAreClosed) {
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(nth("hull", i));
    EXPECT_TRUE(Polytope(families::cloud(rng, 4 + i % 13, 1.0).vertices).closed());
    const auto prism =
        families::prism(3 + i % 7, families::uniform(rng, 0.2, 1), families::uniform(rng, 0.01, 1));
    EXPECT_TRUE(Polytope(prism.vertices).closed());
  }
}

}  // namespace oracle_test
}  // namespace repel
