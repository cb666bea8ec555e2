// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/feature.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include <repel/distance/gjk.hpp>
#include <support/gaps.hpp>
#include <support/quad.hpp>

namespace repel {
namespace feature_test {

using families::Pair;
using families::Rng;

constexpr unsigned seed = 417;

detail::Feature random_feature(Rng& rng, int size) {
  detail::Feature f;
  f.size = size;
  const Vec3 centre = families::uniform(rng, 0.2, 2.0) * families::direction(rng);
  for (int i = 0; i < size; ++i) {
    f.w[i] =
        Vec<double>(Vec3(centre + families::uniform(rng, 0.1, 1.0) * families::direction(rng)));
    f.a[i] = f.w[i];
  }
  return f;
}

TEST(Feature, TheFootIsWhereTheSpanIsSeenAtRightAngles) {
  Rng rng(seed);
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "feature", i));
    const detail::Feature f = random_feature(rng, 1 + i % 3);
    const detail::Foot foot = detail::foot_on(f);
    EXPECT_NEAR(sum(foot.weights), 1.0, 1e-14);
    // A thin face amplifies the rounding errors of its weights.
    EXPECT_LE(to_vec3(f.mean(f.w, foot.weights) - foot.v).norm(), 1e-9);
    for (int k = 1; k < f.size; ++k) EXPECT_NEAR(dot(foot.v, f.w[k] - f.w[0]), 0.0, 1e-9);
  }
}

detail::PosedPair posed(const Convex& A, const Convex& B, const Pair& p) {
  return {A, p.X_WA, B, p.X_WB};
}

TEST(Feature, WhatWasNearestIsConfirmedAndNothingElse) {
  Rng rng(seed);
  const double endless = std::numeric_limits<double>::infinity();
  int confirmed = 0;
  int rejected = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const Pair p = families::draw_apart("random boxes", rng, families::log_uniform(rng, 1e-3, 1.0));
    const Convex A = families::convex(p.A);
    const Convex B = families::convex(p.B);
    const double truth = static_cast<double>(families::truth(p)->distance);
    WarmStart warm;
    ASSERT_EQ(gap_between(A, p.X_WA, B, p.X_WB, {}, warm).end, QueryEnd::converged);
    Gap gap;
    confirmed += detail::confirm_nearest(posed(A, B, p), warm, {}, endless, gap) ? 1 : 0;
    EXPECT_NEAR(gap.distance, truth, 2e-14 * families::size(p));
    // With any other corner instead of the first, the feature is not the answer and must not be
    // accepted.
    WarmStart other = warm;
    other.a[0] = (warm.a[0] + 1 + i % 7) % 8;
    if (detail::confirm_nearest(posed(A, B, p), other, {}, endless, gap)) {
      EXPECT_LE(gap.lower, truth);
      EXPECT_GE(gap.upper, truth);
      EXPECT_NEAR(gap.distance, truth, 2e-14 * families::size(p));
    } else {
      ++rejected;
    }
  }
  EXPECT_GT(confirmed, 1990);
  EXPECT_GT(rejected, 1500);
}

TEST(Feature, ConfirmsNothingThatIsNotFinite) {
  const Convex box = Convex::box({0.1, 0.2, 0.3});
  const double nan = std::nan("");
  const double endless = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, endless, -endless, 1e308}) {
    for (int entry = 0; entry < 12; ++entry) {
      for (int size = 1; size <= 3; ++size) {
        Pose X_WB = Pose::Identity();
        X_WB.translation() = Vec3(1, 2, 3);
        X_WB.matrix()(entry % 3, entry / 3) = bad;
        WarmStart warm;
        warm.size = static_cast<std::uint8_t>(size);
        warm.a = {7, 3, 5, 0};
        warm.b = {0, 1, 2, 0};
        Gap gap;
        EXPECT_FALSE(
            detail::confirm_nearest({box, Pose::Identity(), box, X_WB}, warm, {}, endless, gap))
            << bad << " in entry " << entry;
      }
    }
  }
}

// Barycentric coordinates by Cramer's rule in 113 bits, all positive: the simplex contains the
// origin.
bool surrounds(const std::array<Vec3, 4>& w) {
  using oracle::Real;
  const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return Real(p.x()) * (Real(q.y()) * Real(r.z()) - Real(q.z()) * Real(r.y())) -
           Real(p.y()) * (Real(q.x()) * Real(r.z()) - Real(q.z()) * Real(r.x())) +
           Real(p.z()) * (Real(q.x()) * Real(r.y()) - Real(q.y()) * Real(r.x()));
  };
  const std::array<Real, 4> shares{volume(w[1], w[2], w[3]), -volume(w[0], w[2], w[3]),
                                   volume(w[0], w[1], w[3]), -volume(w[0], w[1], w[2])};
  const auto same = [&](bool positive) {
    return std::all_of(shares.begin(), shares.end(),
                       [&](const Real& x) { return positive ? x > 0 : x < 0; });
  };
  return same(true) || same(false);
}

TEST(Feature, FourCornersAroundTheOriginProveThatTheSetsMeet) {
  Rng rng(seed);
  int around = 0;
  int missed = 0;
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "four corners", i));
    const double flat = i % 4 == 0 ? families::log_uniform(rng, 1e-16, 1e-2) : 1.0;
    std::array<Vec3, 4> corners;
    for (Vec3& corner : corners) {
      corner = families::uniform(rng, 0.1, 1.0) * families::direction(rng);
      corner.z() *= flat;
    }
    const Convex A = Convex::polytope(corners);
    const Vec3 origin = Vec3::Zero();
    const Convex B = Convex::polytope(std::span(&origin, 1));
    const Pose X = Pose::Identity();
    WarmStart warm;
    warm.met_a = {0, 1, 2, 3};
    const bool proven = detail::still_meets({A, X, B, X}, warm);
    const bool true_of_all = surrounds(corners);
    EXPECT_TRUE(!proven || true_of_all);
    around += proven ? 1 : 0;
    missed += true_of_all && !proven && flat == 1.0 ? 1 : 0;
  }
  EXPECT_GT(around, 1000);
  EXPECT_LT(missed, around / 100) << "of those that are not flat hardly one is left unproven";
}

// Regression: beside a sliver of 1e-309 m the square of the distance underflowed to zero, and the
// lower bound was infinite.
TEST(Feature, WhereTheSquareOfTheDistanceUnderflowsNothingIsProven) {
  const Vec<double> w{7e-310, 5e-310, 0.0};
  detail::Feature f;
  f.size = 1;
  f.a[0] = f.w[0] = w;
  Gap gap;
  const double everywhere = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(detail::prove(f, {w}, 3.8e-309, 4e-14, {}, everywhere, gap));
  // As far as this it is proven that nothing is nearer than the margin allows.
  f.a[0] = f.w[0] = {1e-9, 0.0, 0.0};
  EXPECT_TRUE(detail::prove(f, {f.w[0]}, 1e-18, 1e-20, {}, everywhere, gap));
  EXPECT_LE(gap.lower, gap.upper);
}

}  // namespace feature_test
}  // namespace repel
