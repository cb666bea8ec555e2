// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <repel/reduction/shape.hpp>
#include "reduction/posed_boxes.hpp"

namespace repel {
namespace separation_test {

using families::of_seed;
using families::Rng;
using test::PosedBoxes;

constexpr unsigned seed = 1013;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void expect_claims_nothing(const Separation& s) {
  EXPECT_EQ(s.end, QueryEnd::bad_input);
  EXPECT_EQ(s.lower, -infinite);
  EXPECT_EQ(s.upper, infinite);
  EXPECT_EQ(s.extraction_W, Vec3(0, 0, 0));
}

TEST(Separation, ADefaultOneClaimsNothing) {
  expect_claims_nothing(Separation{});
}

TEST(Separation, APoseThatIsNotFiniteClaimsNothingAndLeavesTheWarmStart) {
  const Shape box = Shape::box({0.5, 0.5, 0.5});
  for (const double bad : {not_a_number, infinite, -infinite}) {
    for (int entry = 0; entry < 12; ++entry) {
      SCOPED_TRACE(to_text(bad) + " in entry " + std::to_string(entry));
      Pose X_WB = Pose::Identity();
      X_WB.matrix()(entry % 3, entry / 3) = bad;
      WarmStart warm{{1, 2, 3, 4}, {5, 6, 7, 0}, 3, 2, 1};
      const WarmStart untouched = warm;
      expect_claims_nothing(separation(box, Pose::Identity(), box, X_WB, {}, warm));
      expect_claims_nothing(separation(box, X_WB, box, Pose::Identity(), {}, warm));
      EXPECT_EQ(warm.a, untouched.a);
      EXPECT_EQ(warm.b, untouched.b);
      EXPECT_EQ(warm.size, untouched.size);
    }
  }
}

TEST(Separation, APoseThatIsNotFiniteClaimsNothingAfterAnOverlap) {
  const Shape shapes[] = {Shape::box({0.1, 0.1, 0.1}), Shape::cylinder(0.1, 0.1),
                          Shape::cone(0.1, 0.1)};
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(0.01, 0.01, 0.02);
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      for (const double bad : {not_a_number, infinite, -infinite}) {
        for (int entry = 0; entry < 12; ++entry) {
          WarmStart warm;
          ASSERT_LT(separation(a, Pose::Identity(), b, X_WB, {}, warm).distance, 0.0);
          Pose Y_WB = X_WB;
          Y_WB.matrix()(entry % 3, entry / 3) = bad;
          expect_claims_nothing(separation(a, Pose::Identity(), b, Y_WB, {}, warm));
        }
      }
    }
  }
}

TEST(Separation, WhatIsTooFarClaimsNothing) {
  const Shape box = Shape::box({0.1, 0.1, 0.1});
  Pose X_WB = Pose::Identity();
  X_WB.translation().x() = 9e14;
  EXPECT_EQ(separation(box, Pose::Identity(), box, X_WB).end, QueryEnd::converged);
  for (const double far : {1.1e15, 1e18, 1e100}) {
    X_WB.translation().x() = far;
    expect_claims_nothing(separation(box, Pose::Identity(), box, X_WB));
  }
}

// The corners that a search of few steps has seen may lie in one plane with the origin, which looks
// like contact.
TEST(Separation, AShortSearchDoesNotCallADeepOverlapAContact) {
  Pose X_WA = Pose::Identity();
  X_WA.translation().z() = 0.05;
  const Shape cube = Shape::box({0.1, 0.1, 0.1});
  const Shape slab = Shape::box({0.1, 0.05, 0.2});
  int cut_short = 0;
  for (const Measure measure : {Measure::reduction, Measure::deepest_point, Measure::exact}) {
    for (int iterations = 1; iterations < 12; ++iterations) {
      const Separation s = separation(cube, X_WA, slab, Pose::Identity(),
                                      {.iterations = iterations, .measure = measure});
      EXPECT_NE(s.end, QueryEnd::touching) << iterations;
      EXPECT_LE(s.lower, -0.1);
      cut_short += s.end == QueryEnd::budget_spent ? 1 : 0;
    }
  }
  EXPECT_GT(cut_short, 10);
}

TEST(Separation, OptionsThatMakeNoSenseClaimNothing) {
  const Shape box = Shape::box({0.5, 0.5, 0.5});
  Pose X_WB = Pose::Identity();
  for (const double x : {0.7, 2.0}) {
    X_WB.translation().x() = x;
    for (const QueryOptions& options :
         {QueryOptions{.tolerance = -1e-14}, QueryOptions{.tolerance = not_a_number},
          QueryOptions{.iterations = 0}, QueryOptions{.iterations = -5},
          QueryOptions{.ignore_beyond = not_a_number}, QueryOptions{.ignore_beyond = -1.0},
          QueryOptions{.relative_width = not_a_number}}) {
      expect_claims_nothing(separation(box, Pose::Identity(), box, X_WB, options));
    }
    EXPECT_NE(separation(box, Pose::Identity(), box, X_WB, {.tolerance = 0.0}).end,
              QueryEnd::bad_input);
  }
}

TEST(Separation, WitnessPointsLieOnTheBoxesWhileTheyAreApart) {
  Rng rng(seed);
  int apart = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedBoxes boxes = test::random_boxes(rng, 4.0);
    const Separation s = boxes.separate();
    if (s.distance <= 0.0) continue;
    ++apart;
    EXPECT_NEAR((s.p_WA - s.p_WB).norm(), s.distance, 1e-13);
    EXPECT_NEAR((s.p_WA - s.p_WB).dot(s.extraction_W), s.distance, 1e-13);
    const Vec3 outside_a = (boxes.X_WA.inverse() * s.p_WA).cwiseAbs() - boxes.half_a;
    const Vec3 outside_b = (boxes.X_WB.inverse() * s.p_WB).cwiseAbs() - boxes.half_b;
    EXPECT_NEAR(outside_a.maxCoeff(), 0.0, 1e-13);
    EXPECT_NEAR(outside_b.maxCoeff(), 0.0, 1e-13);
  }
  EXPECT_GT(apart, 300);
}

TEST(Separation, PairsProvenFarApartStopEarly) {
  Rng rng(seed);
  int far = 0;
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const PosedBoxes boxes = test::random_boxes(rng, 4.0);
    const Separation s = boxes.separate({.ignore_beyond = 0.3});
    const double truth = boxes.truth();
    EXPECT_LE(s.lower, truth);
    EXPECT_GE(s.upper, truth);
    EXPECT_EQ(s.end == QueryEnd::far_apart, truth > 0.3);
    if (s.end == QueryEnd::far_apart) {
      EXPECT_GT(s.lower, 0.3);
      ++far;
    } else {
      EXPECT_NEAR(s.distance, boxes.separate().distance, 1e-14 * boxes.size());
    }
  }
  EXPECT_GT(far, 100);
  EXPECT_LT(far, 400);
}

TEST(Separation, ACorruptedWarmStartGivesTheSameAnswer) {
  static_assert(std::is_trivially_copyable_v<WarmStart>);
  Rng rng(seed);
  const std::vector<Shape> shapes{
      Shape::box({0.3, 0.4, 0.5}),  Shape::box({0.5, 0, 0.5}),
      Shape::sphere(0.3),           Shape::capsule(0.1, 0.4),
      Shape::cylinder(0.2, 0.5),    Shape::hull(families::cloud(rng, 12, 0.5).vertices),
      Shape::box({0.05, 0.05, 0.5})};
  int overlaps = 0, total = 0;
  for (const Shape& A : shapes) {
    for (const Shape& B : shapes) {
      // The support points of a rim are all different: GJK ends near the same answer, not exactly
      // at it.
      const bool round = &A == &shapes[4] || &B == &shapes[4];
      for (int i = 0; i < 60; ++i, ++total) {
        SCOPED_TRACE(of_seed(seed, "pair", total));
        const PosedBoxes poses = test::random_boxes(rng, 1.2);
        unsigned char bytes[sizeof(WarmStart)];
        for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(rng());
        WarmStart warm;
        std::memcpy(&warm, bytes, sizeof warm);
        if (i % 2 == 0) {  // existing levels
          warm.level_a = static_cast<std::uint8_t>(warm.level_a % A.levels());
          warm.level_b = static_cast<std::uint8_t>(warm.level_b % B.levels());
        }
        const Separation s = separation(A, poses.X_WA, B, poses.X_WB, {}, warm);
        const Separation cold = separation(A, poses.X_WA, B, poses.X_WB);
        EXPECT_NEAR(s.distance, cold.distance, round ? 1e-10 : 1e-13);
        EXPECT_EQ(s.end, cold.end);
        EXPECT_LE(s.lower, cold.upper);
        EXPECT_GE(s.upper, cold.lower);
        overlaps += cold.distance < 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(overlaps, total * 2 / 10);
  EXPECT_LT(overlaps, total * 9 / 10);
}

TEST(Separation, ABudgetThatRunsOutLeavesATrueBracket) {
  Rng rng(seed);
  int spent = 0, spent_in_overlap = 0, total = 0;
  for (int i = 0; i < 600; ++i) {
    const PosedBoxes boxes = test::random_boxes(rng, 3.0);
    const double truth = boxes.truth();
    WarmStart warm;
    for (int cap = 1; cap <= 6; ++cap, ++total) {
      SCOPED_TRACE(of_seed(seed, "pair", i) + ", " + std::to_string(cap) + " iterations");
      const Separation s = boxes.separate({.iterations = cap});
      EXPECT_LE(s.lower, truth);
      EXPECT_GE(s.upper, truth);
      EXPECT_LE(s.lower, s.distance);
      EXPECT_LE(s.distance, s.upper);
      EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
      EXPECT_LE(s.iterations, 2 * cap + 14) << "both precisions, and the overlap along axes";
      const Separation kept = boxes.separate(warm, {.iterations = cap});
      EXPECT_LE(kept.lower, truth);
      EXPECT_GE(kept.upper, truth);
      if (s.end != QueryEnd::budget_spent) continue;
      ++spent;
      spent_in_overlap += truth < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(spent_in_overlap, 100);
  EXPECT_GT(spent - spent_in_overlap, 100);
  EXPECT_LT(spent, total);
}

TEST(Separation, AnAnswerThatIsNotSpentIsTheAnswer) {
  Rng rng(seed);
  int ended = 0;
  for (int i = 0; i < 300; ++i) {
    const PosedBoxes boxes = test::random_boxes(rng, 3.0);
    const double full = boxes.separate().distance;
    for (int cap = 1; cap <= 40; ++cap) {
      SCOPED_TRACE(of_seed(seed, "pair", i) + ", " + std::to_string(cap) + " iterations");
      const Separation s = boxes.separate({.iterations = cap});
      if (s.end != QueryEnd::converged) continue;
      EXPECT_NEAR(s.distance, full, 1e-13);
      ++ended;
    }
  }
  EXPECT_GT(ended, 1000);
}

TEST(Separation, BoxesThatKissTouch) {
  const Shape A = Shape::box({0.5, 0.25, 1.0});
  const Shape B = Shape::box({0.75, 0.5, 0.125});
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double aside : {0.0, 0.0625}) {  // every sum below is exact in doubles
        SCOPED_TRACE("axis " + std::to_string(axis) + ", aside " + std::to_string(aside));
        Pose X_WB = Pose::Identity();
        X_WB.translation() = Vec3::Constant(aside);
        X_WB.translation()[axis] =
            sign * (Vec3(0.5, 0.25, 1.0)[axis] + Vec3(0.75, 0.5, 0.125)[axis]);
        const Separation s = separation(A, Pose::Identity(), B, X_WB);
        EXPECT_LE(std::abs(s.distance), 1e-15);
        EXPECT_LE(s.lower, 0.0);
        EXPECT_GE(s.upper, 0.0);
        EXPECT_EQ(s.end, QueryEnd::touching);
        EXPECT_NEAR(s.extraction_W[axis], -sign, 1e-6);
      }
    }
  }
}

TEST(Separation, ASphereDeepInACylinderDoesNotTouchIt) {
  Rng rng(seed);
  const Shape sphere = Shape::sphere(0.1);
  const Shape cylinder = Shape::cylinder(0.2, 0.5);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pose", i));
    const Pose X_WB = families::random_pose(rng, 0, 0.19);
    const Separation s = separation(sphere, Pose::Identity(), cylinder, X_WB);
    EXPECT_EQ(s.end, QueryEnd::converged);
    EXPECT_LE(s.distance, -0.1);
  }
}

TEST(Separation, FarFromTheOriginTheAnswerIsTheSame) {
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    PosedBoxes boxes = test::random_boxes(rng, 3.0);
    // Multiples of 2^-20 keep the doubles of the far pose exact.
    for (Pose* X : {&boxes.X_WA, &boxes.X_WB}) {
      X->translation() = (X->translation() * 0x1p20).array().round() * 0x1p-20;
    }
    const Separation near = boxes.separate();
    for (Pose* X : {&boxes.X_WA, &boxes.X_WB}) X->translation() += Vec3(16384, -8192, 4096);
    const Separation far = boxes.separate();
    EXPECT_EQ(near.distance, far.distance);
    EXPECT_EQ(near.extraction_W, far.extraction_W);
    EXPECT_EQ(near.level, far.level);
  }
}

}  // namespace separation_test
}  // namespace repel
