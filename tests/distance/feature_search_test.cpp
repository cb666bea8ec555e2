// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/feature_search.hpp>

#include <gtest/gtest.h>

#include <map>

#include <support/gaps.hpp>

namespace repel {
namespace feature_search_test {

using families::Pair;
using families::Rng;

constexpr unsigned seed = 5821;

/// The answer of the search alone, or nothing if it leaves the pair to the full algorithm.
std::optional<Gap> searched(const Pair& p, const QueryOptions& options = {}) {
  const Convex A = families::convex(p.A);
  const Convex B = families::convex(p.B);
  WarmStart warm;
  Gap gap;
  detail::FeatureSearch search({A, p.X_WA, B, p.X_WB});
  if (!search.run(options, warm, gap)) return std::nullopt;
  return gap;
}

TEST(FeatureSearch, WhatItAnswersIsTrueInEveryFamily) {
  Rng rng(seed);
  std::map<std::string, int> answered;
  for (const std::string& family : families::names()) {
    for (int i = 0; i < 300; ++i) {
      SCOPED_TRACE(family + ", seed " + std::to_string(seed) + ", pair " + std::to_string(i));
      const Pair p = families::draw_apart(family, rng, families::log_uniform(rng, 1e-9, 1.0));
      const std::optional<Gap> gap = searched(p);
      if (!gap) continue;
      ++answered[family];
      const double truth = static_cast<double>(families::truth(p)->distance);
      EXPECT_LE(gap->lower, truth);
      EXPECT_GE(gap->upper, truth);
      EXPECT_LE(std::abs(gap->distance - truth), 2e-14 * families::size(p));
      EXPECT_LE(std::abs(gap->distance - truth), 1e-6 * truth);
    }
  }
  EXPECT_GT(answered["random boxes"], 150);
  EXPECT_GT(answered["random hulls"], 150);
}

TEST(FeatureSearch, AnswersNearlyAllPairsThatAreClearlyApart) {
  Rng rng(seed);
  int answered = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string family = i % 2 == 0 ? "random boxes" : "random hulls";
    answered += searched(families::draw_apart(family, rng, 0.1)) ? 1 : 0;
  }
  EXPECT_GT(answered, 1980) << "seed " << seed;
}

TEST(FeatureSearch, LeavesOverlapToTheCarefulSearch) {
  Rng rng(seed);
  int overlaps = 0;
  int enclosed = 0;
  for (int i = 0; i < 2000; ++i) {
    Pair p = families::draw("random boxes", rng);
    p.X_WB.translation() *= 0.1;
    const auto truth = families::truth(p);
    if (!truth || truth->distance > 0) continue;
    ++overlaps;
    const Convex A = families::convex(p.A);
    const Convex B = families::convex(p.B);
    WarmStart warm;
    Gap gap;
    EXPECT_FALSE(detail::FeatureSearch({A, p.X_WA, B, p.X_WB}).run({}, warm, gap))
        << "seed " << seed << ", pair " << i;
    // The corners that it names leave nothing to search for.
    enclosed += warm.size == 4 && gap_between(A, p.X_WA, B, p.X_WB, {}, warm).iterations == 0;
  }
  EXPECT_GT(overlaps, 1000);
  EXPECT_GT(enclosed, 0.99 * overlaps) << "seed " << seed;
}

TEST(FeatureSearch, StopsWhereTheGapIsProvenLargeEnough) {
  Rng rng(seed);
  int sooner = 0;
  for (int i = 0; i < 500; ++i) {
    const Pair p = families::draw_apart("random boxes", rng, 0.5);
    const std::optional<Gap> all = searched(p);
    const std::optional<Gap> early = searched(p, {.ignore_beyond = 0.2});
    ASSERT_TRUE(all && early) << "seed " << seed << ", pair " << i;
    EXPECT_EQ(early->end, QueryEnd::far_apart);
    EXPECT_GT(early->lower, 0.2);
    EXPECT_LE(early->lower, all->upper);
    EXPECT_GE(early->upper, all->lower);
    sooner += early->iterations < all->iterations ? 1 : 0;
  }
  EXPECT_GT(sooner, 250);
}

}  // namespace feature_search_test
}  // namespace repel
