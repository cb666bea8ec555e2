// SPDX-License-Identifier: BSD-3-Clause
// The deepest common point compared with a different linear programming solver in 113 bits, with
// finite differences, and with exact results for boxes.
#include <repel/reduction/deepest_point.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <repel/reduction/way_out.hpp>
#include <support/draws.hpp>
#include <support/families.hpp>
#include <support/linear_program.hpp>

#include "reduction/posed_boxes.hpp"
#include "reduction/posed_shapes.hpp"

namespace repel {
namespace deepest_point_test {

using families::draws;
using families::of_seed;
using families::Rng;
using oracle::Real;

constexpr unsigned seed = 7331;
const QueryOptions by_deepest_point{.measure = Measure::deepest_point};

using Posed = test::PosedShapes;

Shape random_shape(Rng& rng) {
  switch (families::count_between(rng, 0, 4)) {
    case 0:
      return Shape::hull(families::cloud(rng, families::count_between(rng, 4, 24), 0.5).vertices,
                         {.levels = 2});
    case 1:
      return Shape::sphere(families::uniform(rng, 0.1, 0.5));
    case 2:
      return Shape::capsule(families::uniform(rng, 0.1, 0.3), families::uniform(rng, 0.1, 0.5));
    default:
      return Shape::box(families::random_box(rng, 0.05, 0.6).half_extents);
  }
}

Posed random_pair(Rng& rng) {
  Posed pair{random_shape(rng), random_shape(rng)};
  pair.X_WA.linear() = families::rotation(rng);
  pair.X_WB.linear() = families::rotation(rng);
  pair.X_WA.translation() = families::uniform(rng, 0.0, 3.0) * families::direction(rng);
  pair.X_WB.translation() = pair.X_WA.translation() + families::uniform(rng, 0.0, 0.8) *
                                                          pair.size() * families::direction(rng);
  return pair;
}

/// The linear program about a common point, solved by the simplex tableau; the depths are at least
/// 0.
double oracle_depth(const Posed& pair, const Vec3& common_W) {
  oracle::LinearProgram program({0, 0, 0, 0, 0, 0, 1, 1});
  const auto add = [&](const Shape& shape, const Pose& X_W, bool is_a) {
    const Vec3 own = X_W.inverse() * common_W;
    for (std::uint32_t i = 0; i < shape.planes().size(); ++i) {
      const Vec3 n = to_vec3(shape.planes().normal(i));
      std::vector<Real> row(8);
      for (int k = 0; k < 3; ++k) {
        Real turned = 0;
        for (int j = 0; j < 3; ++j) turned += Real(X_W(k, j)) * Real(n[j]);
        row[static_cast<std::size_t>(k)] = turned;
        row[static_cast<std::size_t>(k) + 3] = -turned;
      }
      row[is_a ? 6 : 7] = 1;
      Real room = shape.planes().offset(i);
      for (int j = 0; j < 3; ++j) room -= Real(n[j]) * Real(own[j]);
      program.add(row, std::max(room, Real(0)));
    }
  };
  add(pair.A, pair.X_WA, true);
  add(pair.B, pair.X_WB, false);
  return static_cast<double>(program.solve()) + pair.A.level(0).depth + pair.B.level(0).depth;
}

TEST(DeepestPoint, IsTheSolutionOfTheLinearProgram) {
  Rng rng(seed);
  int overlapping = 0;
  for (int i = 0; i < draws(3000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    Posed pair = random_pair(rng);
    // Planes nearly parallel: with double precision alone the error would be 1e-8.
    if (i % 3 == 0) {
      const double angle = families::log_uniform(rng, 1e-13, 1e-3);
      pair.X_WB.linear() = families::small_rotation(rng, angle) * pair.X_WA.linear();
    }
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (warm.level_a != WarmStart::deepest_point) continue;
    ++overlapping;
    const Vec3 n = s.extraction_W;
    const double depth = -s.distance;
    EXPECT_NEAR((s.p_WA - s.p_WB).dot(n), -depth, 1e-12);
    const detail::PosedPlanes a{pair.A.planes(), pair.X_WA, pair.A.level(0).core.reach()};
    const detail::PosedPlanes b{pair.B.planes(), pair.X_WB, pair.B.level(0).core.reach()};
    detail::DeepestPoint deepest(a, b);
    WarmStart none;
    ASSERT_TRUE(deepest.solve(none));
    const Vec3 x = pair.X_WA.translation() + to_vec3(deepest.point());
    const double margin = pair.A.planes().margin() + pair.B.planes().margin();
    EXPECT_NEAR(oracle_depth(pair, x), depth, 1e-12 + margin);
  }
  EXPECT_GT(overlapping, draws(1000));
}

// Regression: a pair that had just left an overlap was proven apart in extended precision, and then
// again by the gap search, which is far cheaper.
TEST(DeepestPoint, PairThatMayBeApartIsNotSolvedAtLength) {
  Rng rng(seed);
  int left = 0, at_length = 0;
  for (int i = 0; i < draws(5000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    Posed pair = random_pair(rng);
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (warm.level_a != WarmStart::deepest_point) continue;
    const detail::PosedPlanes a{pair.A.planes(), pair.X_WA, pair.A.level(0).core.reach()};
    const detail::PosedPlanes b{pair.B.planes(), pair.X_WB, pair.B.level(0).core.reach()};
    pair.X_WA.translation() += (0.01 - s.lower) * s.extraction_W;
    WarmStart same = warm;
    detail::DeepestPoint doubted(a, b);
    EXPECT_FALSE(doubted.solve(warm, detail::DeepestPoint::most_pivots, true));
    detail::DeepestPoint plain(a, b);
    EXPECT_FALSE(plain.solve(same));
    ++left;
    at_length += plain.pivots() > doubted.pivots() ? 1 : 0;
    EXPECT_LE(doubted.pivots(), plain.pivots());
    EXPECT_LE(doubted.pivots(), 24);  // those of one attempt in double
    const Separation apart = pair.separate(warm);
    EXPECT_GT(apart.lower, 0.0);
  }
  EXPECT_GT(left, draws(1000));
  EXPECT_GT(at_length, left / 2);
}

TEST(DeepestPoint, IsFoundWhereverBoxesOverlap) {
  Rng rng(seed);
  int overlapping = 0, concentric = 0;
  for (int i = 0; i < draws(20000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    test::PosedBoxes boxes = test::random_boxes(rng, 1.5);
    if (i % 4 == 0) {
      const double angle = families::log_uniform(rng, 1e-12, 1e-2);
      boxes.X_WB.linear() = families::small_rotation(rng, angle) * boxes.X_WA.linear();
    }
    if (i % 50 == 1) boxes.X_WB.translation() = boxes.X_WA.translation();
    const Separation exact = boxes.separate({.measure = Measure::exact});
    if (!(exact.distance < -1e-9)) continue;
    ++overlapping;
    concentric += i % 50 == 1 ? 1 : 0;
    WarmStart warm;
    const Separation s = boxes.separate(warm, by_deepest_point);
    EXPECT_EQ(warm.level_a, WarmStart::deepest_point);
    EXPECT_EQ(s.end, QueryEnd::converged);
    EXPECT_LE(s.iterations, 100);
    EXPECT_GE(s.distance, exact.distance - 1e-14);
  }
  EXPECT_GT(overlapping, draws(5000));
  EXPECT_GT(concentric, draws(300));
}

TEST(DeepestPoint, ChangesNoFasterThanTheShapesMoveAndWarmEqualsCold) {
  Rng rng(seed);
  test::Steps seen;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    const Posed pair = random_pair(rng);
    test::expect_smooth_sweep(pair, rng, 1e-12 * pair.size(), seen);
  }
  EXPECT_EQ(seen.cut_short, 0);
  EXPECT_GT(seen.inside, 3000);
  EXPECT_GT(seen.outside, 3000);
}

// Between parallel faces a whole area is deepest. A warm start used to name another point of it
// than a cold one.
TEST(DeepestPoint, OfManyThatAreAsDeepOneIsTheAnswerWarmAndCold) {
  Rng rng(seed);
  int many = 0;
  for (int i = 0; i < draws(1000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const auto half = [&] { return families::uniform(rng, 0.03, 0.1); };
    Posed pair{Shape::box({half(), half(), half()}), Shape::box({half(), half(), half()})};
    pair.X_WA.translation() = 0.08 * families::direction(rng);
    const Mat3 tilt = families::small_rotation(rng, 0.05);
    Pose before = pair.X_WA;
    before.linear() = tilt;
    WarmStart warm;
    (void)separation(pair.A, before, pair.B, pair.X_WB, by_deepest_point, warm);
    const Separation s = separation(pair.A, pair.X_WA, pair.B, pair.X_WB, by_deepest_point, warm);
    const Separation cold = separation(pair.A, pair.X_WA, pair.B, pair.X_WB, by_deepest_point);
    if (!(cold.distance < -0.001)) continue;
    ++many;
    EXPECT_NEAR(s.distance, cold.distance, 1e-12);
    EXPECT_LE((s.extraction_W - cold.extraction_W).norm(), 1e-9);
    EXPECT_LE((s.p_WA - cold.p_WA).norm(), 1e-9);
    EXPECT_LE((s.p_WB - cold.p_WB).norm(), 1e-9);
  }
  EXPECT_GT(many, draws(500));
}

// Regression: where all points of a segment are as deep, the answer changes from one of its ends to
// the other as it turns. The ratio test allowed for more rounding than there is, and so a warm
// start kept the old end for ten milliradians longer than a cold one.
TEST(DeepestPoint, OfASegmentThatTurnsTheSameEndIsTheAnswerWarmAndCold) {
  const Shape A = Shape::box({0.009, 0.015, 0.018});
  const Shape B = Shape::box({0.011, 0.016, 0.005});
  constexpr double step = 2e-3;  // [rad]
  WarmStart warm;
  double first = 0.0, last = 0.0;  // [m] on which side of the middle
  int differ = 0;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.5 + step * k;
    // The planes halfway through both boxes meet in a line along this.
    const Vec3 along(0.0, std::cos(angle), std::sin(angle));
    const Vec3 thin = Vec3(0.3, 0.0, 0.0) + std::sqrt(0.91) * along.cross(Vec3::UnitX());
    Pose X_WB = Pose::Identity();
    X_WB.linear() << along, thin.cross(along), thin;
    const Pose X_WA = Pose::Identity();
    const Separation s = separation(A, X_WA, B, X_WB, by_deepest_point, warm);
    EXPECT_NEAR(s.distance, -0.014, 1e-12);
    const Vec3 cold = separation(A, X_WA, B, X_WB, by_deepest_point).p_WA;
    differ += (s.p_WA - cold).norm() > 1e-6 ? 1 : 0;
    last = cold.dot(along);
    if (k == 0) first = last;
  }
  EXPECT_LT(first * last, 0.0) << "the end does not change";
  EXPECT_LE(differ, 1);
}

TEST(DeepestPoint, IsMeasuredAlsoFromAWarmStartThatNamesLevels) {
  Rng rng(seed);
  int at_levels = 0;
  for (int i = 0; i < draws(500); ++i) {
    const Posed pair = random_pair(rng);
    // A contact too shallow for a deepest point leaves such a warm start.
    WarmStart warm;
    (void)separation(pair.A, pair.X_WA, pair.B, pair.X_WB, {.measure = Measure::reduction}, warm);
    at_levels += warm.level_a != 0 || warm.level_b != 0 ? 1 : 0;
    EXPECT_NEAR(pair.separate(warm).distance, pair.separate().distance, 1e-13 * pair.size())
        << of_seed(seed, "pair", i);
  }
  EXPECT_GT(at_levels, draws(100));
}

TEST(DeepestPoint, GrowsOnceAndFallsAlongAStraightLine) {
  Rng rng(seed);
  int peaks = 0;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    Posed pair = random_pair(rng);
    const Vec3 along = families::direction(rng);
    std::vector<double> depths;
    for (int k = 0; k <= 200; ++k) {
      pair.X_WA.translation() =
          pair.X_WB.translation() + (0.01 * k - 1.0) * 0.6 * pair.size() * along;
      depths.push_back(std::max(0.0, -pair.separate().distance));
    }
    for (std::size_t k = 2; k < depths.size(); ++k) {
      if (depths[k - 2] > 0.0 && depths[k] > 0.0) {
        EXPECT_GE(depths[k - 1], 0.5 * (depths[k - 2] + depths[k]) - 1e-12) << k;
        ++peaks;
      }
    }
  }
  EXPECT_GT(peaks, 5000);
}

TEST(DeepestPoint, ItsDirectionIsTheGradientByFiniteDifferences) {
  Rng rng(seed);
  int smooth = 0;
  for (int i = 0; i < draws(4000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Posed pair = random_pair(rng);
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (warm.level_a != WarmStart::deepest_point) continue;
    const detail::PosedPlanes a{pair.A.planes(), pair.X_WA, pair.A.level(0).core.reach()};
    const detail::PosedPlanes b{pair.B.planes(), pair.X_WB, pair.B.level(0).core.reach()};
    detail::DeepestPoint deepest(a, b);
    ASSERT_TRUE(deepest.solve(warm));
    const Vec3 g = -to_vec3(deepest.gradient());
    const auto [forward, backward] = test::difference_quotients(pair, 1e-6);
    if ((forward - backward).norm() > 1e-6) continue;  // at an edge of the function
    ++smooth;
    EXPECT_LE((forward - g).norm(), 1e-6);
    EXPECT_LE(g.norm(), 1.0 + 1e-9);
    if (g.norm() > 1e-9) {
      EXPECT_LE((s.extraction_W - g.normalized()).norm(), 1e-9);
    }
  }
  EXPECT_GT(smooth, draws(1000));
}

TEST(DeepestPoint, TheBracketHoldsTheExactDepthOfBoxes) {
  Rng rng(seed);
  std::vector<double> shares;
  for (int i = 0; i < draws(3000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const test::PosedBoxes boxes = test::overlapping_boxes(rng);
    const Separation s = boxes.separate(by_deepest_point);
    EXPECT_LE(s.lower, -boxes.depth());
    EXPECT_GE(s.upper, -boxes.depth());
    EXPECT_LT(s.distance, 0.0);
    shares.push_back(-s.distance / boxes.depth());
  }
  EXPECT_GT(test::median(shares), 0.8);
}

TEST(DeepestPoint, HasNoDeadZoneInShallowContact) {
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    test::PosedBoxes boxes = test::random_boxes(rng, 1.5);
    const Separation apart = boxes.separate();
    if (!(apart.distance > 0.0)) continue;
    boxes.X_WA.translation() -= (apart.distance + 1e-6) * apart.extraction_W;
    const double depth = boxes.depth();
    if (!(depth > 1e-7)) continue;
    EXPECT_LT(boxes.separate(by_deepest_point).distance, -0.05 * depth);
  }
}

TEST(DeepestPoint, AThinFingerPressedIntoABlockFeelsEveryMillimetre) {
  const Shape finger = Shape::box({0.004, 0.004, 0.05});
  const Shape block = Shape::box({0.2, 0.2, 0.1});
  WarmStart warm;
  double before = 0.0;
  for (int mm = 1; mm <= 50; ++mm) {
    Pose X_WA = Pose::Identity();
    X_WA.translation().z() = 0.15 - 1e-3 * mm;
    const Separation s = separation(finger, X_WA, block, Pose::Identity(), by_deepest_point, warm);
    EXPECT_NEAR(s.distance, -1e-3 * mm, 1e-12);
    EXPECT_LT(s.distance, before - 9e-4);
    EXPECT_LE((s.extraction_W - Vec3::UnitZ()).norm(), 1e-9);
    before = s.distance;
  }
}

TEST(DeepestPoint, ConcentricShapesHaveAWayOut) {
  const std::vector<Shape> shapes{Shape::box({0.3, 0.2, 0.1}), Shape::sphere(0.2),
                                  Shape::capsule(0.1, 0.3), Shape::box({0.2, 0.2, 0.2})};
  for (const Shape& A : shapes) {
    for (const Shape& B : shapes) {
      const Separation s = separation(A, Pose::Identity(), B, Pose::Identity(), by_deepest_point);
      EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
      EXPECT_LT(s.distance, -0.15);
      EXPECT_LE(s.lower, s.distance);
    }
  }
}

TEST(DeepestPoint, FlatHullsAreAnsweredByReduction) {
  const std::vector<Vec3> triangle{{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.3, 0.1}};
  const Shape flat = Shape::hull(triangle);
  const Shape box = Shape::box({0.2, 0.3, 0.1});
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(0.1, 0.2, 0.05);
  const Separation deepest = separation(flat, Pose::Identity(), box, X_WB, by_deepest_point);
  const Separation reduction =
      separation(flat, Pose::Identity(), box, X_WB, {.measure = Measure::reduction});
  EXPECT_LT(deepest.distance, 0.0);
  EXPECT_EQ(deepest.distance, reduction.distance);
  EXPECT_EQ(deepest.extraction_W, reduction.extraction_W);
}

TEST(DeepestPoint, AnyContentOfAWarmStartIsSafe) {
  Rng rng(seed);
  for (int i = 0; i < draws(5000); ++i) {
    const Posed pair = random_pair(rng);
    WarmStart warm;
    for (std::size_t k = 0; k < 4; ++k) {
      // Small ids are those of planes, most others are invalid.
      const bool small = families::count_between(rng, 0, 1) == 1;
      warm.a[k] = static_cast<std::uint32_t>(small ? rng() % 12 | (rng() % 2) << 31U : rng());
      warm.b[k] = static_cast<std::uint32_t>(small ? rng() % 12 | (rng() % 2) << 31U : rng());
    }
    warm.level_a = warm.level_b = WarmStart::deepest_point;
    EXPECT_NEAR(pair.separate(warm).distance, pair.separate().distance, 1e-12)
        << of_seed(seed, "pair", i);
  }
}

// Regression: the most violated plane, by rounding alone, was already in the basis. It was
// exchanged with itself until the pivots ran out, so that the levels gave the answer, 0.284 m.
TEST(DeepestPoint, APlaneThatHoldsDoesNotEnterAgain) {
  const Shape A = Shape::box({0x1.5c1c8e5fdddddp-3, 0x1.bc38fbfc8eb97p-3, 0x1.1bd1be26a8918p-2});
  const Shape B = Shape::box({0x1.10aba620079eap-3, 0x1.d54f612a6f202p-2, 0x1.d36c277c5a87p-4});
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
  X_WA.linear() << 0x1.5638a33907bdbp-1, 0x1.d52cb8a8e55c5p-3, 0x1.6a502a6c67f7dp-1,
      -0x1.55c8b9872a19p-2, -0x1.8403628b6314cp-1, 0x1.1f076cdfc8ae5p-1, 0x1.54547d334e18fp-1,
      -0x1.38c7ed77eac69p-1, -0x1.b865cfaa9441cp-2;
  X_WB.linear() << 0x1.78cc6b221921dp-1, 0x1.593a9900b502p-1, -0x1.f5df6cec2d798p-5,
      0x1.55c2772eb336cp-3, -0x1.7cb82170739ap-4, 0x1.f692963681f9dp-1, 0x1.4ff4ea626b33p-1,
      -0x1.77184d9317105p-1, -0x1.728843426c4ap-3;
  X_WB.translation() = Vec3(0x1.0712754a48348p-4, -0x1.d72549d7909efp-5, -0x1.1c4f60373cbbp-4);
  WarmStart warm;
  const Separation s = separation(A, X_WA, B, X_WB, by_deepest_point, warm);
  EXPECT_EQ(s.end, QueryEnd::converged);
  EXPECT_EQ(warm.level_a, WarmStart::deepest_point);
  EXPECT_LE(s.iterations, 60);
}

// Regression: the plane of a face of this sliver misses its tip by a multiple of rounding. A point
// below all planes may still be outside, and the depth was larger than the extraction distance.
TEST(DeepestPoint, InTheTipOfASliverIsNoDeeperThanTheWayOut) {
  const std::vector<Vec3> corners{
      {-0x1.9599f1ae36a33p-1, 0x1.050df068e691ep+2, -0x1.26c72d8604b02p-1},
      {-0x1.eaad5718590e4p+0, -0x1.45d5233b56324p+1, 0x1.5d37a2ca6598fp+1},
      {0x1.c1467376755f1p-1, 0x1.f5baa33a39374p+1, -0x1.3599a05b7a1ccp+0},
      {-0x1.ed464c1870123p+0, -0x1.2d92f08d21a9fp+1, 0x1.718139a7fb78ap+1}};
  const Shape sliver = Shape::hull(corners);
  const Shape box = Shape::box({0x1.1e1e5fa943e14p+0, 0x1.18b8e2a122ba4p-1, 0x1.44252887ea06cp-1});
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
  X_WA.linear() << -0x1.aaacfee2b32e8p-1, -0x1.9c215639f05e7p-2, 0x1.83f6b66ed7c16p-2,
      -0x1.04da3694ae5a3p-1, 0x1.a678619203f32p-1, -0x1.f3e71d75da128p-3, -0x1.b70cdd18afb59p-3,
      -0x1.95f4bc0d9f3c2p-2, -0x1.c90d31e53621cp-1;
  X_WB.linear() << 0x1.505b53c150f9cp-1, -0x1.38d5f375b8487p-1, -0x1.c44aa9c5664b7p-2,
      0x1.9bee544202ecep-2, -0x1.b0f7beb5b731p-3, 0x1.c8139ea57606dp-1, -0x1.4679c4ebf6392p-1,
      -0x1.8697584f85b79p-1, 0x1.b5e5d773d8408p-4;
  X_WB.translation() = Vec3(-0x1.05dddaa6ecea1p+2, 0x1.88e2bd9884c5dp+1, -0x1.40310feec3acp-2);
  const double depth = 0.0030242285565812753;
  const Separation s = separation(sliver, X_WA, box, X_WB, by_deepest_point);
  EXPECT_GE(s.distance, -depth);
  EXPECT_LE(s.distance, -0.99 * depth);
  EXPECT_LE(s.lower, -depth);
  EXPECT_GE(s.upper, -depth);
}

// Regression: rounding relative to a spike of 1000 km let the point be 1e-9 m above the planes of a
// sheet, at whose edge that is 10 m outside: the depth was 4 m, of 0.46 m.
TEST(DeepestPoint, OfASheetBesideASpikeIsInTheSheet) {
  const Shape sheet = Shape::hull(std::vector<Vec3>{{-2.6796875, 0.0, 2.2587890625},
                                                    {2.2587890625, 1e-9, 1e-9},
                                                    {1e-9, 1e-9, 0.009765625},
                                                    {0.0, 1e-9, 1e-9}});
  const Shape spike = Shape::hull(std::vector<Vec3>{{1e-9, 1e-9, 1e-9},
                                                    {2.2587890625, 1e6, 1e-9},
                                                    {13.7587890625, 13.8037109375, 13.8037109375},
                                                    {13.8037109375, 13.8037109375, 13.8037109375},
                                                    {13.8037109375, 2.3037109375, 1e-9},
                                                    {-1.0, 1e-9, 1e-9}});
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
  X_WA.linear() << 0.86187937104303081, -0.28280990001738265, 0.42093052897435185,
      0.42093052897435185, 0.86187937104303081, -0.28280990001738265, -0.28280990001738265,
      0.42093052897435185, 0.86187937104303081;
  X_WB.linear() << -0.84427868873979062, -0.29299573999326867, 0.44871705125347794,
      0.44871705125347794, -0.84427868873979062, 0.29299573999326867, 0.29299573999326867,
      0.44871705125347794, 0.84427868873979084;
  X_WB.translation() = Vec3(0.0, 2.2587890625, 0.0);
  const double depth = 0.4564575;
  for (const Separation& s : {separation(sheet, X_WA, spike, X_WB, by_deepest_point),
                              separation(spike, X_WB, sheet, X_WA, by_deepest_point)}) {
    EXPECT_GE(s.distance, -depth - 1e-6);
    EXPECT_LE(s.distance, -0.5 * depth);
    EXPECT_LE(s.lower, -depth);
    EXPECT_GE(s.upper, -depth);
  }
}

TEST(DeepestPoint, OfSheetsIsBracketedEitherWayRound) {
  Rng rng(seed);
  int overlapping = 0, thin = 0;
  const auto sheet = [&] {
    families::Solid solid = families::cloud(rng, families::count_between(rng, 4, 8), 2.0);
    const double thickness = families::log_uniform(rng, 1e-12, 1.0);
    for (Vec3& v : solid.vertices) v.y() *= thickness;
    thin += thickness < 1e-6 ? 1 : 0;
    return Shape::hull(solid.vertices);
  };
  for (int i = 0; i < draws(4000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Shape A = sheet();
    const Shape B = sheet();
    const Pose X_WA = families::random_pose(rng, 0.0, 2.0);
    const Pose X_WB = families::random_pose(rng, 0.0, 2.0);
    const Separation one = separation(A, X_WA, B, X_WB, by_deepest_point);
    const Separation other = separation(B, X_WB, A, X_WA, by_deepest_point);
    EXPECT_LE(one.lower, other.upper);
    EXPECT_LE(other.lower, one.upper);
    overlapping += one.distance < 0.0 ? 1 : 0;
  }
  EXPECT_GT(overlapping, draws(1000));
  EXPECT_GT(thin, draws(2000));
}

detail::PosedPlanes planes_of(const Shape& box, const Pose& X_W) {
  return {box.planes(), X_W, box.reach()};
}

TEST(BoxStart, IsTheTopOfATableAndTheLowestCornerOfABoxOnIt) {
  const Shape table = Shape::box({1.0, 1.0, 0.1});
  const Shape box = Shape::box({0.1, 0.2, 0.3});
  Pose X_WB = Pose::Identity();
  // The corner against all three of its axes is the lowest.
  X_WB.linear() = Eigen::AngleAxisd(std::acos(1.0 / std::sqrt(3.0)), Vec3(1, -1, 0).normalized())
                      .toRotationMatrix();
  ASSERT_GT(X_WB.linear().row(2).minCoeff(), 0.5);
  X_WB.translation() = Vec3(0.1, 0.2, 0.4);
  const Pose X_WA = Pose::Identity();
  const auto above =
      detail::box_start(planes_of(table, X_WA), planes_of(box, X_WB), Vec<double>(0, 0, 0));
  EXPECT_EQ(above.side, 0U);
  EXPECT_EQ(above.face, 4U);
  EXPECT_EQ(above.corner, (std::array<std::uint32_t, 3>{1, 3, 5}));
  const auto swapped =
      detail::box_start(planes_of(box, X_WB), planes_of(table, X_WA), Vec<double>(0, 0, 0));
  EXPECT_EQ(swapped.side, 1U);
  EXPECT_EQ(swapped.face, above.face);
  EXPECT_EQ(swapped.corner, above.corner);
}

TEST(BoxStart, TheCornerIsBelowTheFaceByTheLeastOverlapOfAllFaces) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const test::PosedBoxes boxes = test::overlapping_boxes(rng);
    const detail::PosedPlanes A = planes_of(boxes.A, boxes.X_WA);
    const detail::PosedPlanes B = planes_of(boxes.B, boxes.X_WB);
    const detail::BoxStart start = detail::box_start(A, B, Vec<double>(0, 0, 0));
    const detail::PosedPlanes& one = start.side == 0 ? A : B;
    const detail::PosedPlanes& other = start.side == 0 ? B : A;
    Vec3 corner(0, 0, 0);
    for (const std::uint32_t face : start.corner) {
      corner += other.planes.offset(face) * to_vec3(other.planes.normal(face));
    }
    const Vec3 n = one.X_W.linear() * to_vec3(one.planes.normal(start.face));
    const double depth =
        one.planes.offset(start.face) - n.dot(other.X_W * corner - one.X_W.translation());
    // The shortest axis is that with the least overlap.
    const PosedShape a{boxes.A, boxes.X_WA};
    const PosedShape b{boxes.B, boxes.X_WB};
    EXPECT_NEAR(depth, detail::overlap_along(detail::shortest_axis(a, b), a, b),
                1e-14 * boxes.size());
  }
}

}  // namespace deepest_point_test
}  // namespace repel
