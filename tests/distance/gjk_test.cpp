// SPDX-License-Identifier: BSD-3-Clause
// The distance compared with a self-certifying 113-bit oracle, over families of pairs that are
// difficult for such algorithms, and properties that need no reference.
#include <repel/distance/gjk.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <support/gaps.hpp>

namespace repel {
namespace gjk_test {

using families::apart_by;
using families::convex;
using families::draw;
using families::draw_apart;
using families::log_uniform;
using families::measure;
using families::Pair;
using families::Rng;
using oracle::Real;

constexpr unsigned seed = 1988;

/// The exact distance minus `bound`, with neither rounded first.
double above(const oracle::Truth& truth, double bound) {
  return static_cast<double>(truth.distance - Real(bound));
}

/// Invariants of every answer: sign, bracket, accuracy, witness points.
void expect_true(const Gap& gap, const oracle::Truth& truth, double size) {
  const double error = std::abs(above(truth, gap.distance));
  ASSERT_FALSE(gap.meets) << "a false collision";
  ASSERT_GE(above(truth, gap.lower), 0.0) << "the bracket misses";
  ASSERT_LE(above(truth, gap.upper), 0.0) << "the bracket misses";
  ASSERT_LE(gap.lower, gap.distance);
  ASSERT_LE(gap.distance, gap.upper);
  ASSERT_EQ(gap.end, QueryEnd::converged);
  EXPECT_GT(gap.distance, 0.0);
  EXPECT_LE(error, 2e-14 * size);
  EXPECT_LE(error, 1e-6 * static_cast<double>(truth.distance));
  const Vec3 n_BA_W = to_vec3(gap.n_BA_W);
  EXPECT_NEAR(n_BA_W.norm(), 1.0, 1e-12);
  const Vec3 between = to_vec3(gap.p_AQa_W - gap.p_AQb_W);
  EXPECT_LE((between - gap.distance * n_BA_W).norm(), 1e-9 * size);
}

class Family : public ::testing::TestWithParam<std::string> {
 protected:
  /// Runs `law` on seeded pairs of the family, 1e-9 to 1 m apart.
  template <class Law>
  void for_pairs(int count, Law&& law) {
    Rng rng(seed);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const double gap = log_uniform(rng, 1e-9, 1.0);
      SCOPED_TRACE(GetParam() + ", seed " + std::to_string(seed) + ", pair " + std::to_string(i) +
                   ", gap " + std::to_string(std::log10(gap)) + " decades");
      law(draw_apart(GetParam(), rng, gap), rng);
    }
  }
};

std::string test_name(const ::testing::TestParamInfo<std::string>& family) {
  std::string name = family.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Family, ::testing::ValuesIn(families::names()), test_name);

TEST_P(Family, IsRightCold) {
  int below_a_micrometre = 0;
  for_pairs(600, [&](const Pair& p, Rng&) {
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth) << "the oracle could not prove its answer";
    if (truth->distance == 0) return;
    below_a_micrometre += truth->distance < Real(1e-6) ? 1 : 0;
    expect_true(measure(p), *truth, families::size(p));
  });
  EXPECT_GT(below_a_micrometre, 100);
}

TEST_P(Family, IsRightAfterASmallMotionFromASolvedPose) {
  int checked = 0;
  for_pairs(400, [&](Pair p, Rng& rng) {
    WarmStart warm;
    measure(p, warm);
    const Pose X_WA = p.X_WA;
    p.X_WA = families::moved_a_little(X_WA, rng);
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth) << "the oracle could not prove its answer";
    if (truth->distance == 0) return;  // the motion has closed the gap
    ++checked;
    expect_true(measure(p, warm), *truth, families::size(p));
  });
  EXPECT_GT(checked, 100);
}

TEST_P(Family, IsTheSameWithAAndBSwapped) {
  for_pairs(200, [](const Pair& p, Rng&) {
    const Gap gap = measure(p);
    const Gap swapped = measure({p.B, p.A, p.X_WB, p.X_WA});
    const double tolerance = 4e-14 * families::size(p);
    EXPECT_NEAR(gap.distance, swapped.distance, std::min(tolerance, 2e-6 * gap.distance));
    EXPECT_LE(swapped.lower, gap.upper);
    EXPECT_LE(gap.lower, swapped.upper);
  });
}

TEST_P(Family, DoesNotDependOnTheOrderOfVerticesOrOnRepeatedOnes) {
  for_pairs(200, [](const Pair& p, Rng& rng) {
    Pair q = p;
    for (families::Solid* s : {&q.A, &q.B}) {
      s->box = false;
      const std::size_t count = s->vertices.size();
      for (std::size_t i = 0; i < count; i += 2) s->vertices.push_back(s->vertices[i]);
      std::shuffle(s->vertices.begin(), s->vertices.end(), rng);
    }
    const Gap gap = measure(p);
    const double tolerance = std::min(4e-14 * families::size(p), 2e-6 * gap.distance);
    EXPECT_NEAR(measure(q).distance, gap.distance, tolerance);
  });
}

TEST_P(Family, AStopAfterAnyNumberOfIterationsLeavesATrueBracket) {
  int stopped = 0;
  for_pairs(150, [&](const Pair& p, Rng&) {
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth);
    for (int iterations = 1; iterations <= 10; ++iterations) {
      const Gap gap = measure(p, {.iterations = iterations});
      ASSERT_GE(above(*truth, gap.lower), 0.0) << iterations;
      ASSERT_LE(above(*truth, gap.upper), 0.0) << iterations;
      ASSERT_FALSE(gap.meets && truth->distance > 0) << iterations;
      stopped += gap.end == QueryEnd::budget_spent ? 1 : 0;
      ASSERT_LE(gap.iterations, 2 * iterations);
    }
  });
  EXPECT_GT(stopped, 100);
}

TEST_P(Family, IsFarApartOnlyWhenItIs) {
  int far = 0;
  for_pairs(150, [&](const Pair& p, Rng&) {
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth);
    for (const double share : {0.3, 0.9, 1.0 + 1e-6, 3.0}) {
      const double limit = share * static_cast<double>(truth->distance);
      const Gap gap = measure(p, {.ignore_beyond = limit});
      ASSERT_GE(above(*truth, gap.lower), 0.0);
      if (gap.end == QueryEnd::far_apart) {
        ++far;
        ASSERT_LT(share, 1.0);
        ASSERT_GE(gap.lower, limit);
      } else if (share > 1.0) {
        ASSERT_EQ(gap.end, QueryEnd::converged);
      }
    }
  });
  EXPECT_GT(far, 100);
}

// The poses move the body 1 km away, where doubles are 1.1e-13 m apart: three coordinates of two
// bodies and nine entries of a rotation are rounded there. The algorithm itself adds no error, as
// IsRightCold shows with the family 10 km away.
TEST_P(Family, ARigidMotionOfBothBodiesChangesNothingButRounding) {
  for_pairs(150, [](const Pair& p, Rng& rng) {
    Pose X = Pose::Identity();
    X.linear() = families::rotation(rng);
    X.translation() = 1e3 * families::direction(rng);
    Pair moved = p;
    moved.X_WA = X * p.X_WA;
    moved.X_WB = X * p.X_WB;
    const double scale = std::max({1.0, families::size(p), p.X_WA.translation().norm() / 1e3});
    EXPECT_NEAR(measure(moved).distance, measure(p).distance, 1e-11 * scale);
  });
}

TEST_P(Family, AnyWarmStartGivesTheAnswerOfAColdOne) {
  for_pairs(200, [](const Pair& p, Rng& rng) {
    WarmStart warm;
    for (int i = 0; i < 4; ++i) {
      warm.a[i] = static_cast<std::uint32_t>(rng());
      warm.b[i] = static_cast<std::uint32_t>(rng() % 16);
    }
    warm.size = static_cast<std::uint8_t>(rng());
    const Gap cold = measure(p);
    const double tolerance = std::min(4e-14 * families::size(p), 2e-6 * cold.distance);
    const Gap gap = measure(p, warm);
    EXPECT_FALSE(gap.meets);
    EXPECT_NEAR(gap.distance, cold.distance, tolerance);
  });
}

TEST_P(Family, OverlapIsFoundWhenThePolytopesShareABall) {
  for_pairs(150, [&](Pair p, Rng& rng) {
    // The centre of B is inside A by at least half its thickness.
    p.A = families::box(p.A.box ? p.A.half_extents : Vec3(0.3, 0.4, 0.5));
    p.B = families::box(p.B.box ? p.B.half_extents : Vec3(0.1, 0.8, 0.2));
    p.X_WB.translation() =
        p.X_WA.translation() + 0.5 * p.A.half_extents.minCoeff() * families::direction(rng);
    const Gap gap = measure(p);
    EXPECT_TRUE(gap.meets);
    EXPECT_EQ(gap.lower, 0.0);
    EXPECT_EQ(gap.distance, 0.0);
  });
}

TEST(Gjk, ADefaultGapClaimsNothing) {
  const Gap gap;
  EXPECT_EQ(gap.lower, 0.0);
  EXPECT_EQ(gap.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(gap.end, QueryEnd::bad_input);
  EXPECT_FALSE(gap.meets);
}

// Near-parallel faces give triangles so thin that the point nearest to the origin is 4e-14 off
// their plane, while the witness points are on the boxes.
TEST(Gjk, AThinTriangleDoesNotShiftTheDistance) {
  Rng rng(7);
  for (int i = 0; i < 1500; ++i) {
    Pair p = draw_apart("parallel faces", rng, log_uniform(rng, 1e-9, 1.0));
    WarmStart warm;
    measure(p, warm);
    p.X_WA = families::moved_a_little(p.X_WA, rng);
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth);
    if (truth->distance == 0) continue;
    const double error = std::abs(above(*truth, measure(p, warm).distance));
    EXPECT_LE(error, 2e-14 * families::size(p)) << "seed 7, pair " << i;
  }
}

TEST(Gjk, AWarmStartThatStillHoldsCostsOneSupportPair) {
  Rng rng(seed);
  int once = 0;
  for (int i = 0; i < 200; ++i) {
    Pair p = draw_apart("random boxes", rng, log_uniform(rng, 1e-2, 1.0));
    WarmStart warm;
    measure(p, warm);
    p.X_WA = families::moved_a_little(p.X_WA, rng);
    once += measure(p, warm).iterations == 1 ? 1 : 0;
  }
  EXPECT_GT(once, 180) << "seed " << seed;
}

TEST(Gjk, NeverNeedsMoreThanAFewDozenSupportPairs) {
  Rng rng(seed);
  int worst = 0;
  for (const std::string& family : families::names()) {
    for (int i = 0; i < 100; ++i) {
      worst =
          std::max(worst, measure(draw_apart(family, rng, log_uniform(rng, 1e-9, 1))).iterations);
    }
  }
  EXPECT_LE(worst, 64) << "seed " << seed;
}

TEST(Gjk, ANarrowRelativeWidthGivesTwelveDigitsDownToANanometre) {
  Rng rng(seed);
  int extended = 0;
  for (const std::string& family : families::names()) {
    for (int i = 0; i < 60; ++i) {
      const Pair p = draw_apart(family, rng, log_uniform(rng, 1e-9, 1e-3));
      const auto truth = families::truth(p);
      ASSERT_TRUE(truth);
      const Gap gap = measure(p, {.relative_width = 1e-12});
      const double distance = static_cast<double>(truth->distance);
      EXPECT_LE(std::abs(above(*truth, gap.distance)), 1e-12 * distance)
          << family << ", seed " << seed << ", pair " << i;
      extended += gap.extended ? 1 : 0;
    }
  }
  EXPECT_GT(extended, 500);
}

}  // namespace gjk_test
}  // namespace repel
