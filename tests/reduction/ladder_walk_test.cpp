// SPDX-License-Identifier: BSD-3-Clause
// Properties of the signed distance in overlap. References: for boxes the 15 axes in 113-bit
// arithmetic, which are exact; for cylinders dense directions, an upper bound of the depth.
#include <repel/reduction/ladder_walk.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/draws.hpp>

#include "reduction/posed_boxes.hpp"

namespace repel {
namespace ladder_walk_test {

using families::draws;
using families::of_seed;
using families::Rng;
using test::PosedBoxes;
using test::Sweep;

constexpr unsigned seed = 907;
const QueryOptions by_reduction{.measure = Measure::reduction};

TEST(SeparationInOverlap, ChangesNoFasterThanTheBoxesMove) {
  Rng rng(seed);
  int inside = 0, total = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    PosedBoxes boxes = test::random_boxes(rng, 0.1, {.levels = 1 + i % 16});
    const Sweep sweep(boxes, rng);
    boxes.X_WA.translation() = sweep.from;
    double before = boxes.separate(by_reduction).distance;
    for (double share = 0.0; share < 1.0;) {
      const double step = families::log_uniform(rng, 1e-10, 3e-2);
      const Vec3 was = boxes.X_WA.translation();
      share += step;
      boxes.X_WA.translation() = sweep.at(share);
      const double moved = (boxes.X_WA.translation() - was).norm();
      const double now = boxes.separate(by_reduction).distance;
      ASSERT_LE(std::abs(now - before), moved + 1e-12);
      before = now;
      inside += now < 0.0 ? 1 : 0;
      ++total;
    }
  }
  EXPECT_GT(inside, total / 10);
  EXPECT_LT(inside, total * 9 / 10);
}

TEST(SeparationInOverlap, BracketHoldsTheExactDepthAndTheSignIsRight) {
  Rng rng(seed);
  int overlaps = 0;
  for (int i = 0; i < 1500; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedBoxes boxes = test::random_boxes(rng, 3.0, {.levels = 1 + i % 20});
    const double truth = boxes.truth();
    const Separation s = boxes.separate(by_reduction);
    ASSERT_FALSE(std::isnan(truth));
    EXPECT_LE(s.lower, truth);
    EXPECT_GE(s.upper, truth);
    EXPECT_EQ(s.distance > 0.0, truth > 0.0);
    EXPECT_EQ(s.level == 0, truth > 0.0);
    EXPECT_LE(-s.distance, std::max(0.0, -truth) + 1e-15 * boxes.size());
    EXPECT_EQ(s.end, QueryEnd::converged);
    EXPECT_GE(s.distance, s.lower);
    EXPECT_LE(s.distance, s.upper);
    overlaps += truth < 0.0 ? 1 : 0;
  }
  EXPECT_GT(overlaps, 1500 * 3 / 10);
  EXPECT_LT(overlaps, 1500 * 8 / 10);
}

// If the shapes intersect and their next levels are farther apart than the sum of their depths, the
// distance stays at 0. A box eroded by t retracts by at most t sqrt(3), which bounds the depth
// there.
TEST(SeparationInOverlap, IsZeroOnlyInOverlapShallowerThanTheFirstStep) {
  for (const int levels : {1, 8, 64}) {
    SCOPED_TRACE(of_seed(seed, "levels", levels));
    Rng rng(seed);
    int zero = 0;
    for (int i = 0; i < draws(1000); ++i) {
      const PosedBoxes boxes = test::overlapping_boxes(rng, {.levels = levels});
      if (boxes.separate(by_reduction).distance < 0.0) continue;
      ++zero;
      const double first_step = boxes.A.level(1).depth + boxes.B.level(1).depth;
      EXPECT_LE(boxes.depth(), (std::sqrt(3.0) - 1.0) * first_step + 1e-15);
    }
    EXPECT_LE(zero, draws(levels == 1 ? 100 : 20)) << "of " << draws(1000);
  }
}

TEST(SeparationInOverlap, MostOfTheExactDepthOfRandomBoxesIsReported) {
  Rng rng(seed);
  std::vector<double> fractions;
  for (int i = 0; i < draws(2000); ++i) {
    const PosedBoxes boxes = test::overlapping_boxes(rng);
    fractions.push_back(-boxes.separate(by_reduction).distance / boxes.depth());
  }
  EXPECT_GE(test::median(fractions), 0.6) << "seed " << seed;
  RecordProperty("median_fraction", std::to_string(test::median(fractions)));
}

TEST(SeparationInOverlap, MoreLevelsNeverMakeTheMedianErrorLarger) {
  double before = 1.0;
  for (const int levels : {1, 2, 4, 8, 16, 32, 64}) {
    Rng rng(seed);
    std::vector<double> errors;
    for (int i = 0; i < draws(400); ++i) {
      const PosedBoxes boxes = test::overlapping_boxes(rng, {.levels = levels});
      errors.push_back(1.0 + boxes.separate(by_reduction).distance / boxes.depth());
    }
    EXPECT_LE(test::median(errors), before) << levels << " levels, seed " << seed;
    before = test::median(errors);
  }
}

TEST(SeparationInOverlap, ExtractionIsAUnitVectorEverywhere) {
  Rng rng(seed);
  const std::vector<Shape> shapes{
      Shape::box({0.3, 0.4, 0.5}), Shape::box({0.5, 0.5, 0.5}),
      Shape::box({0.5, 0, 0.5}),   Shape::box({0, 0, 0}),
      Shape::sphere(0.3),          Shape::sphere(0),
      Shape::capsule(0.1, 0.4),    Shape::cylinder(0.2, 0.5),
      Shape::cylinder(0.5, 0.0),   Shape::hull(families::cloud(rng, 12, 0.5).vertices)};
  for (std::size_t a = 0; a < shapes.size(); ++a) {
    for (std::size_t b = 0; b < shapes.size(); ++b) {
      for (int i = 0; i < 12; ++i) {
        SCOPED_TRACE(of_seed(seed, "pose", i) + ", shapes " + std::to_string(a) + " " +
                     std::to_string(b));
        Pose X_WA = Pose::Identity();
        if (i > 0) X_WA.linear() = families::rotation(rng);
        if (i > 6) X_WA.translation() = 0.2 * families::direction(rng);
        Pose X_WB = X_WA;  // the same pose, the same centre, then a centre nearby
        if (i > 3) X_WB.linear() = families::rotation(rng);
        if (i > 8) X_WB.translation() += families::log_uniform(rng, 1e-17, 1) * Vec3::UnitX();
        const Separation s = separation(shapes[a], X_WA, shapes[b], X_WB, by_reduction);
        EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
        EXPECT_TRUE(is_finite(s.p_WA) && is_finite(s.p_WB));
        EXPECT_TRUE(std::isfinite(s.lower) && std::isfinite(s.upper));
        EXPECT_LE(s.lower, s.distance);
        EXPECT_LE(s.distance, s.upper);
        EXPECT_NE(s.end, QueryEnd::bad_input);
      }
    }
  }
}

TEST(SeparationInOverlap, MovingAByTheLowerBoundAlongTheExtractionSeparates) {
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    PosedBoxes boxes = test::overlapping_boxes(rng);
    if (i % 10 == 0) boxes.X_WB.translation() = boxes.X_WA.translation();
    const Separation s = boxes.separate(by_reduction);
    ASSERT_LT(s.lower, 0.0);
    boxes.X_WA.translation() -= s.lower * s.extraction_W;
    EXPECT_LE(boxes.depth(), 1e-14 * boxes.size());
    EXPECT_GE(boxes.separate(by_reduction).distance, -1e-14 * boxes.size());
  }
}

/// [m] Difference between `depth` and the closest sum of depths of two levels.
double from_a_pair_of_levels(const PosedBoxes& boxes, double depth) {
  double least = 1e300;
  for (int i = 0; i < boxes.A.levels(); ++i) {
    for (int j = 0; j < boxes.B.levels(); ++j) {
      const double sum = boxes.A.level(i).depth + boxes.B.level(j).depth;
      least = std::min(least, std::abs(depth - sum));
    }
  }
  return least;
}

// The distance is determined by the first separated pair of levels, or by the last intersecting
// pair; then it stays constant at the depth of that pair and the witness points are less deep.
TEST(SeparationInOverlap, WitnessPointsAreTheDistanceApartUnlessItStandsStill) {
  Rng rng(seed);
  int decided_by_apart = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedBoxes boxes = test::overlapping_boxes(rng);
    const Separation s = boxes.separate(by_reduction);
    const double along = (s.p_WA - s.p_WB).dot(s.extraction_W);
    EXPECT_GE(along, s.distance - 1e-14);
    if (std::abs(along - s.distance) < 1e-13) {
      ++decided_by_apart;
      continue;
    }
    EXPECT_LE(from_a_pair_of_levels(boxes, -s.distance), 1e-15);
  }
  EXPECT_GT(decided_by_apart, 300);
  EXPECT_LT(decided_by_apart, 1000);
}

TEST(SeparationInOverlap, WarmEqualsColdAlongSweeps) {
  Rng rng(seed);
  int inside = 0, total = 0, warm_cost = 0, cold_cost = 0;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    PosedBoxes boxes = test::random_boxes(rng, 0.1, {.levels = 1 + i % 16});
    const Sweep sweep(boxes, rng);
    const int steps = i % 2 == 0 ? 2000 : 20;  // a tool's motion, and jumps
    const Mat3 turn = families::small_rotation(rng, i % 2 == 0 ? 1e-3 : 0.2);
    WarmStart warm;
    for (int k = 0; k <= steps; ++k) {
      boxes.X_WA.translation() = sweep.at(static_cast<double>(k) / steps);
      boxes.X_WA.linear() = turn * boxes.X_WA.linear();
      const Separation by_warm = boxes.separate(warm, by_reduction);
      const Separation by_cold = boxes.separate(by_reduction);
      ASSERT_NEAR(by_warm.distance, by_cold.distance, 1e-13);
      ASSERT_EQ(by_warm.level == 0, by_cold.level == 0);
      warm_cost += by_warm.iterations;
      cold_cost += by_cold.iterations;
      inside += by_cold.distance < 0.0 ? 1 : 0;
      ++total;
    }
  }
  EXPECT_GT(inside, total / 10);
  EXPECT_LT(inside, total * 9 / 10);
  EXPECT_LT(warm_cost, cold_cost) << "the warm start saves nothing";
}

// Where the line within a finger decides, its distance from the plate is more than all depths: the
// shapes look disjoint.
TEST(SeparationInOverlap, TakesNoLongerWithMoreLevelsWhenWarm) {
  for (const int levels : {2, 8, 64}) {
    const Shape finger = Shape::box({0.01, 0.015, 0.06}, {.levels = levels});
    const Shape plate = Shape::box({0.1, 0.1, 0.002}, {.levels = levels});
    WarmStart warm;
    int most = 0;
    int deep = 0;
    for (int step = 0; step < 400; ++step) {
      Pose X_WA = Pose::Identity();
      X_WA.translation() = Vec3(0.013, 0.007, 0.1 - 0.0005 * step);
      const Separation s = separation(finger, X_WA, plate, Pose::Identity(), by_reduction, warm);
      ASSERT_EQ(s.end, QueryEnd::converged);
      const Separation cold = separation(finger, X_WA, plate, Pose::Identity(), by_reduction);
      ASSERT_NEAR(s.distance, cold.distance, 1e-15);
      most = std::max(most, s.iterations);
      deep += s.distance < -0.0115 ? 1 : 0;
    }
    EXPECT_GT(deep, 100) << levels;
    EXPECT_LE(most, 40) << levels;
  }
}

TEST(SeparationInOverlap, HullsChangeNoFasterThanTheyMoveWarmOrCold) {
  Rng rng(seed);
  int inside = 0, total = 0;
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    const Shape A =
        Shape::hull(families::cloud(rng, families::count_between(rng, 4, 40), 0.5).vertices);
    const Shape B =
        Shape::hull(families::cloud(rng, families::count_between(rng, 4, 40), 0.8).vertices);
    PosedBoxes poses = test::random_boxes(rng, 0.1);
    const Sweep sweep(poses, rng);
    WarmStart warm;
    Separation before = separation(A, poses.X_WA, B, poses.X_WB, by_reduction, warm);
    for (double share = 0.0; share < 1.0; share += families::log_uniform(rng, 1e-6, 2e-2)) {
      const Vec3 was = poses.X_WA.translation();
      poses.X_WA.translation() = sweep.at(share);
      const Separation now = separation(A, poses.X_WA, B, poses.X_WB, by_reduction, warm);
      const Separation cold = separation(A, poses.X_WA, B, poses.X_WB, by_reduction);
      ASSERT_NEAR(now.distance, cold.distance, 1e-13);
      ASSERT_LE(std::abs(now.distance - before.distance),
                (poses.X_WA.translation() - was).norm() + 1e-12);
      before = now;
      inside += now.distance < 0.0 ? 1 : 0;
      ++total;
    }
  }
  EXPECT_GT(inside, total / 20);
  EXPECT_LT(inside, total * 9 / 10);
}

TEST(SeparationInOverlap, SwappingTheShapesTurnsTheExtractionRound) {
  Rng rng(seed);
  int overlaps = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedBoxes boxes = test::random_boxes(rng, 3.0);
    const Separation s = boxes.separate(by_reduction);
    const Separation swapped = separation(boxes.B, boxes.X_WB, boxes.A, boxes.X_WA, by_reduction);
    EXPECT_NEAR(s.distance, swapped.distance, 1e-14 * boxes.size());
    EXPECT_LE((s.extraction_W + swapped.extraction_W).norm(), 1e-6);
    overlaps += s.distance < 0.0 ? 1 : 0;
  }
  EXPECT_GT(overlaps, 200);
  EXPECT_LT(overlaps, 900);
}

TEST(SeparationInOverlap, AThinFingerPressedIntoABlockIsFeltAllTheWay) {
  Rng rng(seed);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(of_seed(seed, "finger", i));
    PosedBoxes boxes({0.005, 0.005, 0.05}, {0.15, 0.15, 0.12});
    const double lean = i == 0 ? 0.0 : families::uniform(rng, 0.0, 0.3);
    boxes.X_WA.linear() = (Eigen::AngleAxisd(families::uniform(rng, 0, 3), Vec3::UnitZ()) *
                           Eigen::AngleAxisd(lean, Vec3::UnitX()))
                              .toRotationMatrix();
    double reach = 0.0;  // of the finger below its centre
    for (int k = 0; k < 3; ++k) reach += std::abs(boxes.X_WA.linear()(2, k)) * boxes.half_a[k];
    const Vec3 above(families::uniform(rng, -0.05, 0.05), families::uniform(rng, -0.05, 0.05), 0);
    double before = 0.0;
    for (double pressed = 0.0005; pressed <= 0.05; pressed += 0.0005) {
      boxes.X_WA.translation() = above + (0.12 + reach - pressed) * Vec3::UnitZ();
      const Separation s = boxes.separate(by_reduction);
      EXPECT_LT(s.distance, before) << "no deeper at " << pressed;
      EXPECT_GE(-s.distance, i == 0 ? pressed - 1e-15 : 0.6 * pressed) << "at " << pressed;
      EXPECT_LE(-s.distance, pressed + 1e-15);
      EXPECT_GT(s.extraction_W.z(), 0.9);
      before = s.distance;
    }
    EXPECT_LT(before, -0.04) << "eight times the half width of the finger";
  }
}

/// [m] Far point of a cylinder along the unit vector n, from its centre.
double cylinder_reach(double radius, double half_length, const Vec3& axis, const Vec3& n) {
  return half_length * std::abs(axis.dot(n)) + radius * axis.cross(n).norm();
}

struct PosedCylinder {
  double radius, half_length;  ///< [m]
  Pose X_WC = Pose::Identity();
};

/// [m] Translation of A along the unit vector n that separates it from B.
double overlap(const PosedCylinder& A, const PosedCylinder& B, const Vec3& n) {
  return cylinder_reach(A.radius, A.half_length, A.X_WC.linear().col(2), n) +
         cylinder_reach(B.radius, B.half_length, B.X_WC.linear().col(2), n) -
         (A.X_WC.translation() - B.X_WC.translation()).dot(n);
}

/// [m] The penetration depth, slightly overestimated: the least overlap over a spiral of
/// directions, the best ones refined by random steps that shrink when they fail.
double sampled_depth(const PosedCylinder& A, const PosedCylinder& B, Rng& rng) {
  std::vector<std::pair<double, Vec3>> found;
  const auto add = [&](const Vec3& n) { found.emplace_back(overlap(A, B, n), n); };
  for (int i = 0; i < 2000; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / 2000.0;
    const double angle = 2.399963229728653 * i;
    const double across = std::sqrt(1.0 - z * z);
    add({across * std::cos(angle), across * std::sin(angle), z});
  }
  for (const double sign : {-1.0, 1.0}) {
    add(sign * A.X_WC.linear().col(2));
    add(sign * B.X_WC.linear().col(2));
  }
  std::partial_sort(found.begin(), found.begin() + 8, found.end(),
                    [](const auto& x, const auto& y) { return x.first < y.first; });
  double least = 1e300;
  for (int k = 0; k < 8; ++k) {
    auto [best, n] = found[k];
    double step = 0.1;
    for (int draw = 0; draw < 1000; ++draw) {
      const Vec3 tried = (n + step * families::direction(rng)).normalized();
      const double value = overlap(A, B, tried);
      step *= value < best ? 1.5 : 0.95;
      if (value >= best) continue;
      best = value;
      n = tried;
    }
    least = std::min(least, best);
  }
  return least;
}

TEST(SeparationInOverlap, CylindersLieInsideTheirBracket) {
  Rng rng(seed);
  const auto random_cylinder = [&] {
    PosedCylinder C{families::uniform(rng, 0.1, 0.5), families::uniform(rng, 0.1, 0.5)};
    C.X_WC.linear() = families::rotation(rng);
    C.X_WC.translation() = families::uniform(rng, 0, 0.4) * families::direction(rng);
    return C;
  };
  int overlaps = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedCylinder A = random_cylinder();
    const PosedCylinder B = random_cylinder();
    const double sampled = sampled_depth(A, B, rng);
    if (sampled < 1e-3) continue;
    ++overlaps;
    const Separation s = separation(Shape::cylinder(A.radius, A.half_length), A.X_WC,
                                    Shape::cylinder(B.radius, B.half_length), B.X_WC);
    // The overlap along any direction is an upper bound of the depth.
    const double along = overlap(A, B, s.extraction_W);
    const double depth = std::min(sampled, along);
    EXPECT_NEAR(-s.lower, along, 1e-13);
    EXPECT_GE(-s.lower, along - 1e-15);
    EXPECT_LE(-s.distance, depth + 1e-14);
    EXPECT_LE(-s.upper, depth);
    EXPECT_LE(s.distance, 0.0);
  }
  EXPECT_GT(overlaps, 100);
}

}  // namespace ladder_walk_test
}  // namespace repel
