// SPDX-License-Identifier: BSD-3-Clause
// Defects that users of other libraries reported for distance and overlap of two convex shapes, one
// test each, named after the public tracker and the number of the report. The situations are
// rebuilt from the reports; reference values are from closed forms, the 113-bit oracle or the 15
// axes of two boxes.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/exact_depth.hpp>
#include <support/gaps.hpp>

namespace repel {
namespace complaints_test {

using families::Rng;

constexpr unsigned seed = 1993;
constexpr double infinite = std::numeric_limits<double>::infinity();

Pose at(const Vec3& p) {
  Pose X = Pose::Identity();
  X.translation() = p;
  return X;
}
Pose anywhere(Rng& rng, double distance) {
  Pose X = at(distance * families::direction(rng));
  X.linear() = families::rotation(rng);
  return X;
}
const Pose home = Pose::Identity();
const Shape cube = Shape::box({0.5, 0.5, 0.5});

Shape tetrahedron() {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return Shape::hull(vertices);
}

Shape shape(const families::Solid& s) {
  return s.box ? Shape::box(s.half_extents) : Shape::hull(s.vertices);
}
Separation solve(const families::Pair& p, const QueryOptions& options = {}) {
  return separation(shape(p.A), p.X_WA, shape(p.B), p.X_WB, options);
}

std::string nth(int i) {
  return families::of_seed(seed, "pair", i);
}

/// Invariants for any shapes: finite numbers, a direction, an ordered bracket.
void expect_sound(const Separation& s) {
  EXPECT_NE(s.end, QueryEnd::bad_input);
  EXPECT_TRUE(std::isfinite(s.distance));
  EXPECT_TRUE(is_finite(s.p_WA));
  EXPECT_TRUE(is_finite(s.p_WB));
  EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
  EXPECT_LE(s.lower, s.distance);
  EXPECT_LE(s.distance, s.upper);
}

/// A pair of boxes that may overlap, and its depth [m], negative when apart.
struct Boxes {
  Vec3 half_a, half_b;
  Pose X_WA, X_WB;

  explicit Boxes(Rng& rng) {
    half_a = families::random_box(rng, 0.1, 1.0).half_extents;
    half_b = families::random_box(rng, 0.1, 1.0).half_extents;
    X_WA = anywhere(rng, 0.8);
    X_WB = anywhere(rng, 0.8);
  }
  [[nodiscard]] double depth() const {
    return oracle::penetration_depth(half_a, X_WA, half_b, X_WB);
  }
  [[nodiscard]] Separation solve(const QueryOptions& options = {}) const {
    return separation(Shape::box(half_a), X_WA, Shape::box(half_b), X_WB, options);
  }
};

// FCL: in the diagonal case the normal was not a unit vector, and normal and depth were off by sqrt
// 3.
TEST(Complaint, Fcl545DiagonalCaseHasUnitNormalAndRightDepth) {
  const Vec3 diagonal = Vec3::Ones().normalized();
  for (const double gap : {0.25, 1e-3, -1e-3, -0.1}) {
    const Shape ball = Shape::sphere(0.25);
    const Pose X_WB = at(Vec3::Constant(0.5) + (0.25 + gap) * diagonal);
    const Separation s = separation(ball, X_WB, cube, home);
    EXPECT_NEAR(s.distance, gap, 1e-15);
    EXPECT_LE((s.extraction_W - diagonal).norm(), 1e-14 / (0.25 + gap));
    const Separation balls = separation(ball, at((0.5 + gap) * diagonal), ball, home);
    EXPECT_NEAR(balls.distance, gap, 1e-15);
    EXPECT_LE((balls.extraction_W - diagonal).norm(), 1e-14);
  }
}

// libccd: wrong answers if one body was 25 times the size of the other.
TEST(Complaint, Libccd17SizeRatioOf25) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(nth(i));
    families::Pair p = families::draw("random boxes", rng);
    p.A = families::random_box(rng, 2.4, 2.6);
    p.B = families::random_box(rng, 0.09, 0.11);
    p.X_WB.translation() = families::uniform(rng, 5.0, 6.0) * families::direction(rng);
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth);
    EXPECT_NEAR(solve(p).distance, static_cast<double>(truth->distance), 1e-14);
  }
}

// libccd: the direction was NaN for mutually aligned cubes.
TEST(Complaint, Libccd25AlignedCubesHaveADirection) {
  for (const double z : {3.0, 1.0 + 1e-9, 1.0, 1.0 - 1e-9, 0.5, 1e-9, 0.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Separation s = separation(cube, at(z * Vec3::Unit(axis)), cube, home);
      expect_sound(s);
      EXPECT_EQ(s.distance > 0.0, z > 1.0) << z;
      if (z >= 0.5) {
        EXPECT_GT(s.extraction_W[axis], 0.9) << z;
      }
    }
  }
}

// libccd, FCL: unbounded loops; box against box never returned.
TEST(Complaint, Fcl578BoxBoxReturns) {
  Rng rng(seed);
  int worst = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(nth(i));
    Boxes boxes(rng);
    if (i % 2 == 0) {
      const double angle = families::log_uniform(rng, 1e-17, 1e-6);
      boxes.X_WB.linear() = boxes.X_WA.linear() * families::small_rotation(rng, angle);
    }
    if (i % 3 == 0) boxes.half_b.z() = 0.0;
    const Separation s = boxes.solve();
    expect_sound(s);
    EXPECT_NE(s.end, QueryEnd::budget_spent);
    worst = std::max(worst, s.iterations);
  }
  EXPECT_LE(worst, 150) << "seed " << seed;
}

// libccd: an unbounded loop.
TEST(Complaint, Libccd7TheCapOnIterationsIsKept) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    const Boxes boxes(rng);
    for (const int cap : {1, 3, 10}) {
      // The same number again in extended precision, plus the axes tested as the fallback for the
      // extraction direction.
      EXPECT_LE(boxes.solve({.iterations = cap}).iterations, 2 * cap + 16) << nth(i);
    }
  }
}

// FCL: out of iterations, the solver returned its intermediate state as the answer.
TEST(Complaint, Fcl366IterationLimitIsNotAnAnswer) {
  Rng rng(seed);
  int spent = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(nth(i));
    const Boxes boxes(rng);
    const double depth = boxes.depth();
    const Separation s = boxes.solve({.iterations = 2});
    if (s.end == QueryEnd::budget_spent) ++spent;
    if (s.end == QueryEnd::converged && s.distance > 0) {
      EXPECT_LE(s.upper - s.lower, 1e-7);
    }
    EXPECT_GE(s.upper, -depth - 1e-14);
    if (depth > 0) {
      EXPECT_LE(s.lower, -depth + 1e-14);
    }
  }
  EXPECT_GT(spent, 100) << "seed " << seed;
}

// FCL: a collinear simplex led to NaN.
TEST(Complaint, Fcl293CollinearSimplex) {
  const std::vector<Vec3> beads{{-1, 0, 0}, {-0.5, 0, 0}, {0, 0, 0}, {0.25, 0, 0}, {1, 0, 0}};
  const Shape line = Shape::hull(beads);
  WarmStart collinear;
  collinear.a = {0, 1, 2, 4};
  collinear.b = {4, 3, 2, 0};
  collinear.size = 4;
  for (const double offset : {0.0, 1e-12, 1e-6, 0.5}) {
    for (const double rise : {1e-9, 1e-3, 2.0}) {
      WarmStart warm = collinear;
      const Separation s = separation(line, at({offset, 0, rise}), line, home, {}, warm);
      expect_sound(s);
      EXPECT_NEAR(s.distance, rise, 1e-15);
    }
    WarmStart warm = collinear;
    expect_sound(separation(line, at({offset, 0, 0}), line, home, {}, warm));
  }
  WarmStart warm = collinear;
  EXPECT_NEAR(separation(line, at({2.5, 0, 0}), line, home, {}, warm).distance, 0.5, 1e-15);
}

// FCL: the nearest points reported did not lie on the surfaces.
TEST(Complaint, Fcl302WitnessPointsLieOnTheSurfaces) {
  Rng rng(seed);
  int apart = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(nth(i));
    const Boxes boxes(rng);
    const Separation s = boxes.solve();
    if (!(s.distance > 0)) continue;
    ++apart;
    const Vec3 in_a = (boxes.X_WA.inverse() * s.p_WA).cwiseAbs() - boxes.half_a;
    const Vec3 in_b = (boxes.X_WB.inverse() * s.p_WB).cwiseAbs() - boxes.half_b;
    EXPECT_NEAR(in_a.maxCoeff(), 0.0, 1e-14);
    EXPECT_NEAR(in_b.maxCoeff(), 0.0, 1e-14);
    EXPECT_NEAR((s.p_WA - s.p_WB).norm(), s.distance, 1e-14);
  }
  EXPECT_GT(apart, 200) << "seed " << seed;
}

// FCL: it was unclear in which frame the nearest points are.
TEST(Complaint, Fcl382WitnessPointsAreInTheWorld) {
  const Separation s = separation(Shape::sphere(0.5), at({10, 20, 33}), cube, at({10, 20, 30}));
  EXPECT_LE((s.p_WA - Vec3(10, 20, 32.5)).norm(), 1e-14);
  EXPECT_LE((s.p_WB - Vec3(10, 20, 30.5)).norm(), 1e-14);
  EXPECT_LE((s.extraction_W - Vec3::UnitZ()).norm(), 1e-15);
}

// FCL: assertions failed in the depth search for shapes that just touch.
TEST(Complaint, Fcl493KissingContact) {
  const Shape ball = Shape::sphere(0.5);
  const Shape can = Shape::cylinder(0.5, 0.5);
  const Shape pill = Shape::capsule(0.25, 0.25);
  for (const Shape& A : {cube, ball, can, pill}) {
    for (const Shape& B : {cube, ball, can, pill}) {
      const Separation s = separation(A, at({0, 0, 1}), B, home);
      expect_sound(s);
      EXPECT_NEAR(s.distance, 0.0, 1e-14);
      EXPECT_GT(s.extraction_W.z(), 0.5);
    }
  }
}

// FCL: the penetration of meshes was always 0.
TEST(Complaint, Fcl491OverlappingHullsHaveADepth) {
  const Separation s = separation(tetrahedron(), home, tetrahedron(), at({0.1, 0.1, 0.1}));
  expect_sound(s);
  EXPECT_LT(s.distance, -0.01);
  EXPECT_LE(s.lower, s.distance);
}

// Coal, Drake: after the depth search failed, the distance was undefined or an exception thrown.
TEST(Complaint, Coal147OverlapAlwaysHasAnAnswer) {
  Rng rng(seed);
  for (const std::string& family : families::names()) {
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE(family + ", " + nth(i));
      families::Pair p = families::draw(family, rng);
      p.X_WB.translation() = p.X_WA.translation();
      const Separation s = solve(p);
      expect_sound(s);
      EXPECT_NE(s.end, QueryEnd::budget_spent);
    }
  }
}

// Coal: the result depended on the order of the vertices.
TEST(Complaint, Coal346VertexOrder) {
  Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(nth(i));
    families::Pair p = families::draw_apart("random hulls", rng, 0.1);
    const double distance = solve(p).distance;
    std::shuffle(p.A.vertices.begin(), p.A.vertices.end(), rng);
    std::shuffle(p.B.vertices.begin(), p.B.vertices.end(), rng);
    EXPECT_NEAR(solve(p).distance, distance, 1e-14);
  }
}

// Coal: minus infinity when a vertex met a vertex.
TEST(Complaint, Coal325VertexOnVertex) {
  for (const double gap : {0.0, 1e-15, 1e-9, -1e-9, 0.1}) {
    const Separation s = separation(cube, at(Vec3::Constant(1.0 + gap)), cube, home);
    expect_sound(s);
    EXPECT_NEAR(s.distance, std::sqrt(3.0) * std::max(gap, 0.0), 1e-9 + 1e-15);
    EXPECT_EQ(s.distance > 0, gap > 0);
  }
}

// Coal: wrong distances at a tolerance of 1e-6.
TEST(Complaint, Coal604Tolerance1e6) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(nth(i));
    const double gap = families::log_uniform(rng, 1e-6, 1.0);
    const families::Pair p = families::draw_apart("random boxes", rng, gap);
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth);
    const double exact = static_cast<double>(truth->distance);
    const Separation s = solve(p, {.tolerance = 1e-6});
    EXPECT_NEAR(s.distance, exact, 1e-6 * exact + 1e-14);
    EXPECT_LE(s.lower, exact);
    EXPECT_GE(s.upper, exact);
  }
}

// Coal: no convergence close to contact.
TEST(Complaint, Coal37NearContact) {
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(nth(i));
    const double gap = families::log_uniform(rng, 1e-13, 1e-6);
    const Separation s = solve(families::draw_apart("random boxes", rng, gap));
    EXPECT_NEAR(s.distance, gap, 1e-15 * 8);
    EXPECT_EQ(s.end, QueryEnd::converged);
    EXPECT_LE(s.iterations, 80);
  }
}

// openGJK: 2 of 10 000 pairs reported apart although they overlap, off by tens of centimetres.
TEST(Complaint, OpenGjk13NoFalseNegatives) {
  Rng rng(seed);
  int meeting = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Boxes boxes(rng);
    const double depth = boxes.depth();
    meeting += depth > 0 ? 1 : 0;
    const Convex A = Convex::box(boxes.half_a);
    const Convex B = Convex::box(boxes.half_b);
    WarmStart warm;
    const Gap gap = gap_between(A, boxes.X_WA, B, boxes.X_WB, {}, warm);
    if (std::abs(depth) > 1e-14) {
      ASSERT_EQ(gap.meets, depth > 0) << nth(i);
    }
    ASSERT_GE(gap.upper, -depth) << nth(i);
  }
  EXPECT_GT(meeting, 0.3 * count) << "seed " << seed;
  EXPECT_LT(meeting, 0.7 * count) << "seed " << seed;
}

// openGJK: NaN for bodies with large coordinates.
TEST(Complaint, OpenGjk41LargeCoordinates) {
  for (const double far : {1e3, 1e6, 1e9, 1e12}) {
    const Separation s = separation(cube, at({far + 4.0, far, far}), cube, at({far, far, far}));
    expect_sound(s);
    EXPECT_EQ(s.distance, 3.0) << far;
  }
  const Shape huge = Shape::box(Vec3::Constant(1e6));
  EXPECT_NEAR(separation(huge, home, huge, at({2e6 + 0.5, 1e5, 1e5})).distance, 0.5, 1e-8);
}

// Bullet: cancellation far from the world's origin.
TEST(Complaint, Bullet2157FarFromOrigin) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    const double gap = families::log_uniform(rng, 1e-9, 1.0);
    const families::Pair p = families::draw_apart("ten km away", rng, gap);
    const auto truth = families::truth(p);
    ASSERT_TRUE(truth) << nth(i);
    EXPECT_NEAR(solve(p).distance, static_cast<double>(truth->distance), 2e-14) << nth(i);
  }
}

// Bullet: a positive distance for overlapping shapes.
TEST(Complaint, Bullet1623PositiveDistanceWhilePenetrating) {
  Rng rng(seed);
  int overlapping = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(nth(i));
    const Boxes boxes(rng);
    const double depth = boxes.depth();
    if (!(depth > 1e-14)) continue;
    ++overlapping;
    const Separation s = boxes.solve();
    ASSERT_LE(s.distance, 0.0);
    ASSERT_GE(s.distance, -depth - 1e-14);
    ASSERT_LE(s.lower, -depth + 1e-14);
    ASSERT_GE(s.upper, -depth - 1e-14);
  }
  EXPECT_GT(overlapping, 900) << "seed " << seed;
}

// Bullet: a margin of 0.04 hidden in every shape exceeded the size of small bodies.
TEST(Complaint, Bullet2584NoHiddenMargin) {
  for (const double size : {1.0, 1e-3, 1e-6, 1e-9}) {
    const Shape box = Shape::box(Vec3::Constant(size));
    const Shape can = Shape::cylinder(size, size);
    const Shape ball = Shape::sphere(size);
    for (const Shape& A : {box, can, ball}) {
      for (const Shape& B : {box, can, ball}) {
        const Separation s = separation(A, at({0, 0, 2.5 * size}), B, home);
        EXPECT_NEAR(s.distance, 0.5 * size, 1e-14 * size) << size;
      }
    }
  }
}

// Bullet: the normal flipped near the surface.
TEST(Complaint, Bullet889NormalDoesNotFlip) {
  const Shape table = Shape::box({2.0, 2.0, 0.5});
  const std::array<Shape, 4> tools{cube, Shape::cylinder(0.25, 0.5), Shape::sphere(0.5),
                                   Shape::capsule(0.25, 0.25)};
  for (const Shape& tool : tools) {
    WarmStart warm;
    for (int step = -2000; step <= 2000; ++step) {
      const double height = 1.0 + step * 1e-6;
      const Separation s = separation(tool, at({0.3, 0.2, height}), table, home, {}, warm);
      ASSERT_GT(s.extraction_W.z(), 0.999) << height;
    }
  }
}

// MuJoCo: distance exactly 0 for 103 of 3000 separated pairs. A separating plane proves that they
// are.
TEST(Complaint, Mujoco3383NeverZeroWhenSeparated) {
  Rng rng(seed);
  for (int i = 0; i < 3000;) {
    const Boxes boxes(rng);
    const double apart = -boxes.depth();
    if (!(apart > 1e-14)) continue;
    SCOPED_TRACE(nth(i++));
    const Separation s = boxes.solve();
    ASSERT_GT(s.distance, 0.0);
    ASSERT_GE(s.distance, apart - 1e-14);
    ASSERT_GT(s.lower, 0.0);
  }
}

// MuJoCo: negative distance for separated shapes.
TEST(Complaint, Mujoco1784NeverNegativeWhenSeparated) {
  Rng rng(seed);
  const std::array<Shape, 4> shapes{cube, Shape::cylinder(0.5, 0.5), Shape::sphere(0.5),
                                    Shape::capsule(0.25, 0.25)};
  for (int i = 0; i < 500; ++i) {
    const double gap = families::log_uniform(rng, 1e-12, 1e-3);
    const Pose X = anywhere(rng, 0.0);
    for (const Shape& A : shapes) {
      for (const Shape& B : shapes) {
        const Separation s = separation(A, X * at({0, 0, 1.0 + gap}), B, X);
        ASSERT_NEAR(s.distance, gap, 1e-13) << nth(i);
        ASSERT_GT(s.distance, 0.0) << nth(i);
        ASSERT_GT(s.upper, 0.0) << nth(i);
      }
    }
  }
}

// mujoco_warp: the result depended on the place of the pair in the world.
TEST(Complaint, MujocoWarp1613TranslationInvariance) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(nth(i));
    Boxes boxes(rng);
    // Multiples of 2^-20 remain exact when translated by whole metres.
    for (Pose* X : {&boxes.X_WA, &boxes.X_WB}) {
      X->translation() = (X->translation() * 0x1p20).array().round().matrix() * 0x1p-20;
    }
    const Separation here = boxes.solve();
    boxes.X_WA.translation() += Vec3(12345, -6789, 1e6);
    boxes.X_WB.translation() += Vec3(12345, -6789, 1e6);
    const Separation there = boxes.solve();
    EXPECT_EQ(here.distance, there.distance);
    EXPECT_EQ(here.lower, there.lower);
    EXPECT_EQ(here.upper, there.upper);
    EXPECT_EQ(here.extraction_W, there.extraction_W);
    EXPECT_EQ(here.iterations, there.iterations);
  }
}

// FCL, moveit2: between parallel faces the nearest point jumps; the distance and the normal must
// not.
TEST(Complaint, Fcl393ParallelFacesDistanceDoesNotJump) {
  WarmStart warm;
  double before = 0.0;
  const Vec3 half(0.5, 0.4, 0.1);
  for (int step = -1000; step <= 1000; ++step) {
    const double tilt = 1e-8 * step;
    Pose X_WA = at({1e-4 * step, 0, 0.5});
    X_WA.linear() = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
    const Separation s = separation(Shape::box(half), X_WA, cube, at({0, 0, -0.5}), {}, warm);
    if (step > -1000) {
      ASSERT_LE(std::abs(s.distance - before), 1.1e-8) << step;
    }
    ASSERT_GT(s.extraction_W.z(), 1.0 - 1e-9) << step;
    before = s.distance;
  }
}

// moveit2: jitter near objects. The signed distance must change no faster than the shape moves.
TEST(Complaint, Moveit2108SmallMotionsMakeSmallChanges) {
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(nth(i));
    Boxes boxes(rng);
    const double before = boxes.solve().distance;
    const double step = families::log_uniform(rng, 1e-9, 1e-2);
    boxes.X_WA.translation() += step * families::direction(rng);
    ASSERT_LE(std::abs(boxes.solve().distance - before), step + 1e-13);
  }
}

// Drake: alternate calls on the same pair gave different answers.
TEST(Complaint, Drake10286AlternateCallsAgree) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(nth(i));
    const Boxes one(rng);
    const Boxes other(rng);
    const Separation first = one.solve();
    for (int again = 0; again < 3; ++again) {
      expect_sound(other.solve());
      const Separation s = one.solve();
      EXPECT_EQ(s.distance, first.distance);
      EXPECT_EQ(s.extraction_W, first.extraction_W);
      EXPECT_EQ(s.p_WA, first.p_WA);
      EXPECT_EQ(s.iterations, first.iterations);
    }
  }
}

// tesseract: state from earlier queries prevented later contacts from being found.
TEST(Complaint, Tesseract626WhatOneQueryLeavesDoesNotSpoilTheNext) {
  Rng rng(seed);
  WarmStart warm;
  const Shape other = Shape::box({0.3, 0.6, 0.2});
  for (int i = 0; i < 3000; ++i) {
    const Pose X_WA = anywhere(rng, families::uniform(rng, 0.0, 1.5));
    const Separation cold = separation(other, X_WA, cube, home);
    const Separation s = separation(other, X_WA, cube, home, {}, warm);
    ASSERT_NEAR(s.distance, cold.distance, 1e-14) << nth(i);
  }
}

// FCL: the normal was zero or ambiguous, mostly at contact and for concentric shapes.
TEST(Complaint, Fcl8NormalNeverZero) {
  const std::vector<Shape> shapes{cube,
                                  Shape::sphere(0.5),
                                  Shape::sphere(0.0),
                                  Shape::capsule(0.25, 0.5),
                                  Shape::capsule(0.0, 0.0),
                                  Shape::cylinder(0.5, 0.5),
                                  Shape::cylinder(0.5, 0.0),
                                  Shape::box({0.5, 0.5, 0.0}),
                                  Shape::box({0.0, 0.0, 0.5}),
                                  tetrahedron()};
  for (const Shape& A : shapes) {
    for (const Shape& B : shapes) {
      for (const double z : {0.0, 1e-300, 1e-16, 1e-9, 0.25, 0.5, 1.0, 2.0}) {
        expect_sound(separation(A, at({0, 0, z}), B, home));
        expect_sound(separation(A, at({z, z, 0}), B, home));
      }
    }
  }
}

// Drake: the gradient was NaN at contact.
TEST(Complaint, Drake14789GradientAtContactIsFinite) {
  const Shape ball = Shape::sphere(0.5);
  for (const Vec3& p : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0, 0)}) {
    const Separation s = separation(ball, at(p), cube, home);
    expect_sound(s);
    EXPECT_GE(s.extraction_W.dot(p), 0.0);
  }
}

// trajopt: the returned gradient was not the derivative of the distance.
TEST(Complaint, Trajopt588GradientIsTheDerivative) {
  Rng rng(seed);
  const std::vector<Shape> shapes{cube, Shape::sphere(0.3), Shape::capsule(0.1, 0.4),
                                  Shape::cylinder(0.3, 0.4), tetrahedron()};
  for (int i = 0; i < 300; ++i) {
    const Pose X_WA = anywhere(rng, families::uniform(rng, 2.5, 4.0));
    const Pose X_WB = anywhere(rng, 0.0);
    const Shape& A = shapes[i % shapes.size()];
    const Shape& B = shapes[i / shapes.size() % shapes.size()];
    const Separation s = separation(A, X_WA, B, X_WB);
    ASSERT_GT(s.distance, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double h = 1e-5;
      Pose ahead = X_WA;
      Pose behind = X_WA;
      ahead.translation()[axis] += h;
      behind.translation()[axis] -= h;
      const double slope =
          (separation(A, ahead, B, X_WB).distance - separation(A, behind, B, X_WB).distance) /
          (2.0 * h);
      EXPECT_NEAR(slope, s.extraction_W[axis], 1e-4) << nth(i) << ", axis " << axis;
    }
  }
}

// openGJK: unexplained NaN. Input that is not finite must be refused, and the answer must bound
// nothing.
TEST(Complaint, OpenGjk52NanIsRefused) {
  for (const double bad : {std::nan(""), infinite, -infinite}) {
    const Separation s = separation(cube, at({bad, 0, 0}), cube, home);
    EXPECT_EQ(s.end, QueryEnd::bad_input);
    EXPECT_EQ(s.lower, -infinite);
    EXPECT_EQ(s.upper, infinite);
  }
}

}  // namespace complaints_test
}  // namespace repel
