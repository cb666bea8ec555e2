// SPDX-License-Identifier: BSD-3-Clause
// The deepest common point for round sides, compared with the exact depths of cylinders and cones,
// with prisms solved by another solver, and with finite differences.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <accuracy/specimen.hpp>
#include <support/draws.hpp>
#include <support/linear_program.hpp>

#include "reduction/posed_shapes.hpp"

namespace repel {
namespace round_sides_test {

using families::draws;
using families::of_seed;
using families::Rng;
using oracle::Real;

constexpr unsigned seed = 5153;

/// A convex body whose depths have closed forms: a cylinder, a cone or a box.
struct Body {
  enum class Kind : std::uint8_t { cylinder, cone, box };
  Kind kind = Kind::box;
  Vec3 half = Vec3::Zero();  ///< [m] of round ones: radius, radius and half length

  [[nodiscard]] Shape shape() const {
    if (kind == Kind::cylinder) return Shape::cylinder(half.x(), half.z());
    if (kind == Kind::cone) return Shape::cone(half.x(), half.z());
    return Shape::box(half);
  }
  /// [m] of a point in the frame of the body; negative outside
  [[nodiscard]] double depth(const Vec3& x) const {
    if (kind == Kind::box) return (half - x.cwiseAbs()).minCoeff();
    const double rho = std::hypot(x.x(), x.y());
    if (kind == Kind::cylinder) return std::min(half.x() - rho, half.z() - std::abs(x.z()));
    const double length = 2.0 * half.z();
    const double beside = (half.x() * (half.z() - x.z()) - length * rho);
    return std::min(half.z() + x.z(), beside / std::hypot(half.x(), length));
  }
  /// The normals (unit) and offsets of a prism of that many sides around the body.
  [[nodiscard]] std::vector<Facet> prism(int sides) const {
    std::vector<Facet> planes{{{}, -Vec3::UnitZ(), half.z()}};
    if (kind != Kind::cone) planes.push_back({{}, Vec3::UnitZ(), half.z()});
    if (kind == Kind::box) {
      for (const double side : {1.0, -1.0}) {
        planes.push_back({{}, side * Vec3::UnitX(), half.x()});
        planes.push_back({{}, side * Vec3::UnitY(), half.y()});
      }
      return planes;
    }
    const double rise = kind == Kind::cone ? 2.0 * half.z() : 1.0;
    const double lean = kind == Kind::cone ? half.x() : 0.0;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * M_PI * i / sides;
      Vec3 n(rise * std::cos(angle), rise * std::sin(angle), lean);
      n.normalize();
      planes.push_back({{},
                        n,
                        n.dot(Vec3(half.x() * std::cos(angle), half.x() * std::sin(angle),
                                   kind == Kind::cone ? -half.z() : 0.0))});
    }
    return planes;
  }
};

/// From thin discs to needles; the first is round.
Body random_body(Rng& rng, int kinds) {
  Body body;
  body.kind = static_cast<Body::Kind>(families::count_between(rng, 0, kinds - 1));
  body.half = families::random_box(rng, 0.02, 0.6).half_extents;
  return body;
}

struct Posed : test::PosedShapes {
  Body a, b;

  Posed(const Body& one, const Body& other)
      : PosedShapes{one.shape(), other.shape()}, a(one), b(other) {}

  /// [m] Sum of the depths of a point, each at least 0, or -1 outside of one.
  [[nodiscard]] double depth(const Vec3& x) const {
    const double of_a = a.depth(X_WA.inverse() * x);
    const double of_b = b.depth(X_WB.inverse() * x);
    return of_a < 0.0 || of_b < 0.0 ? -1.0 : of_a + of_b;
  }
};

Posed random_pair(Rng& rng) {
  Posed pair(random_body(rng, 2), random_body(rng, 3));
  pair.X_WA.linear() = families::rotation(rng);
  pair.X_WB.linear() = families::rotation(rng);
  if (families::count_between(rng, 0, 3) == 0) pair.X_WB.linear() = pair.X_WA.linear();
  pair.X_WB.translation() =
      families::uniform(rng, 0.0, 0.6) * pair.size() * families::direction(rng);
  return pair;
}

/// Measured by the deepest point, not by the fallback to levels.
bool is_measured(const Separation& s, const WarmStart& warm) {
  return s.end == QueryEnd::converged && warm.level_a == WarmStart::deepest_point;
}

TEST(RoundSides, NoPointIsDeeperThanTheDeepest) {
  Rng rng(seed);
  int measured = 0, overlapping = 0;
  for (int i = 0; i < draws(3000); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Posed pair = random_pair(rng);
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (!(s.lower < -1e-6)) continue;
    ++overlapping;
    if (!is_measured(s, warm)) continue;
    ++measured;
    const double depth = -s.distance;
    const double error = 1e-9 * pair.size();
    const detail::PosedPlanes a{pair.A.planes(), pair.X_WA, pair.A.reach()};
    const detail::PosedPlanes b{pair.B.planes(), pair.X_WB, pair.B.reach()};
    detail::DeepestPoint deepest(a, b);
    ASSERT_TRUE(deepest.solve(warm));
    const Vec3 x = pair.X_WA.translation() + to_vec3(deepest.point());
    EXPECT_NEAR(deepest.depth(0) + deepest.depth(1), depth, error);
    EXPECT_NEAR(pair.a.depth(pair.X_WA.inverse() * x), deepest.depth(0), error);
    EXPECT_NEAR(pair.b.depth(pair.X_WB.inverse() * x), deepest.depth(1), error);
    for (int k = 0; k < 400; ++k) {
      const double step = families::log_uniform(rng, 1e-6, 1.0) * pair.size();
      EXPECT_LE(pair.depth(x + step * families::direction(rng)), depth + error);
    }
  }
  EXPECT_GT(overlapping, draws(2000));
  EXPECT_GE(measured, overlapping - overlapping / 200);
}

TEST(RoundSides, AreThoseOfAPrismOfManySides) {
  constexpr int sides = 48;
  Rng rng(seed);
  int measured = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Posed pair = random_pair(rng);
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (!is_measured(s, warm)) continue;
    ++measured;
    const detail::PosedPlanes a{pair.A.planes(), pair.X_WA, pair.A.reach()};
    const detail::PosedPlanes b{pair.B.planes(), pair.X_WB, pair.B.reach()};
    detail::DeepestPoint deepest(a, b);
    ASSERT_TRUE(deepest.solve(warm));
    const Vec3 x = to_vec3(deepest.point());
    oracle::LinearProgram program({0, 0, 0, 0, 0, 0, 1, 1});
    const auto add = [&](const Body& body, const Pose& X, bool is_a) {
      for (const Facet& f : body.prism(sides)) {
        const Vec3 n = X.linear() * f.n;
        std::vector<Real> row(8);
        for (std::size_t k = 0; k < 3; ++k) {
          row[k] = n[k];
          row[k + 3] = -n[k];
        }
        row[is_a ? 6 : 7] = 1;
        program.add(row, std::max(0.0, f.offset - n.dot(x - X.translation())));
      }
    };
    add(pair.a, pair.X_WA, true);
    add(pair.b, pair.X_WB, false);
    const auto of_prisms = static_cast<double>(program.solve());
    // The edges of a prism protrude by this.
    const double out = pair.size() * (1.0 / std::cos(M_PI / sides) - 1.0);
    EXPECT_LE(-s.distance, of_prisms + 1e-9);
    EXPECT_GE(-s.distance, of_prisms - 2.0 * out);
  }
  EXPECT_GT(measured, 30);
}

TEST(RoundSides, ChangeNoFasterThanTheShapesMoveAndWarmEqualsCold) {
  Rng rng(seed);
  test::Steps seen;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    const Posed pair = random_pair(rng);
    test::expect_smooth_sweep(pair, rng, 1e-9 * pair.size(), seen);
  }
  EXPECT_GT(seen.inside, 3000);
  EXPECT_GT(seen.outside, 3000);
  EXPECT_LE(seen.cut_short, 3) << "by the levels that stand in, none is wrong";
}

TEST(RoundSides, TurnedSlowlyWarmEqualsCold) {
  Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(of_seed(seed, "sweep", i));
    Posed pair = random_pair(rng);
    const Mat3 turn = families::small_rotation(rng, 1e-3);
    WarmStart warm;
    for (int k = 0; k < 50; ++k) {
      pair.X_WA.linear() = turn * pair.X_WA.linear();
      const Separation s = pair.separate(warm);
      const Separation cold = pair.separate();
      EXPECT_EQ(s.end, cold.end);
      EXPECT_NEAR(s.distance, cold.distance, 1e-9 * pair.size()) << k;
    }
  }
}

TEST(RoundSides, TheirDirectionIsTheGradientByFiniteDifferences) {
  Rng rng(seed);
  int smooth = 0;
  for (int i = 0; i < 1500; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Posed pair = random_pair(rng);
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (!is_measured(s, warm)) continue;
    const auto [forward, backward] = test::difference_quotients(pair, 1e-4);
    const Vec3 g = 0.5 * (forward + backward);
    if ((forward - backward).norm() > 1e-2 || g.norm() < 0.1) continue;
    ++smooth;
    EXPECT_LE((s.extraction_W - g.normalized()).norm(), 2e-2);
  }
  EXPECT_GT(smooth, 500);
}

TEST(RoundSides, OverlapOfANanometreIsOverlap) {
  Rng rng(seed);
  int touching = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    Posed pair = random_pair(rng);
    pair.X_WB.translation() *= 3.0;
    const Separation apart = pair.separate();
    if (!(apart.distance > 1e-3)) continue;
    ++touching;
    // The nearest point of A moves into B, towards its centre.
    const Pose X_WA = pair.X_WA;
    const Vec3 to_centre = pair.X_WB.translation() - apart.p_WB;
    for (const double depth : {1e-9, 1e-6}) {
      const double share = depth * pair.size() / pair.b.depth(Vec3::Zero());
      const Vec3 x = apart.p_WB + share * to_centre;
      pair.X_WA.translation() = X_WA.translation() + x - apart.p_WA;
      const double reached = pair.b.depth(pair.X_WB.inverse() * x);
      EXPECT_LE(pair.separate().distance, -reached + 3e-10 * pair.size()) << depth;
      pair.X_WA.translation() =
          X_WA.translation() + (depth * pair.size() - apart.distance) * apart.extraction_W;
      EXPECT_GT(pair.separate().distance, 0.0) << depth;
    }
  }
  EXPECT_GT(touching, 500);
}

TEST(RoundSides, TheBracketHoldsTheDepth) {
  Rng rng(seed);
  int overlapping = 0;
  for (int i = 0; i < draws(100); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const auto one = accuracy::make(i % 2 == 0 ? "cylinder" : "cone", rng);
    const auto other = accuracy::make(accuracy::kinds()[rng() % accuracy::kinds().size()], rng);
    Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
    X_WA.linear() = families::rotation(rng);
    X_WB.linear() = families::rotation(rng);
    X_WB.translation() =
        families::uniform(rng, 0.0, 0.5) * (one.size + other.size) * families::direction(rng);
    const Separation s = separation(one.shape, X_WA, other.shape, X_WB);
    if (!(s.lower < 0.0)) continue;
    ++overlapping;
    const accuracy::PosedPair pair(one, X_WA, other, X_WB);
    const double depth = pair.depth_by_search(s.extraction_W, rng);
    EXPECT_GE(s.upper, -depth);
    EXPECT_LE(s.lower, -depth + 1e-6);  // the search is not exact to the last digit
    EXPECT_GE(-s.distance, 0.3 * depth);
  }
  EXPECT_GT(overlapping, draws(50));
}

TEST(RoundSides, AreExactWhereTheDepthIsKnown) {
  const Shape post = Shape::cylinder(0.1, 0.5);
  const auto depth = [](const Shape& A, const Shape& B, const Vec3& p, const Mat3& R) {
    Pose X_WB = Pose::Identity();
    X_WB.translation() = p;
    X_WB.linear() = R;
    const Separation s = separation(A, Pose::Identity(), B, X_WB);
    EXPECT_EQ(s.end, QueryEnd::converged);
    EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
    return -s.distance;
  };
  const Mat3 upright = Mat3::Identity();
  const Mat3 across = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()).toRotationMatrix();
  EXPECT_NEAR(depth(post, post, {0.09, 0.12, 0.2}, upright), 0.05, 1e-10);
  EXPECT_NEAR(depth(post, post, {0.15, 0.0, 0.2}, across), 0.05, 1e-10);
  EXPECT_NEAR(depth(post, post, {0.0, 0.0, 0.95}, upright), 0.05, 1e-10);
  EXPECT_NEAR(depth(post, post, {0.0, 0.0, 0.0}, upright), 0.2, 1e-10);
  EXPECT_NEAR(depth(post, Shape::box({1, 1, 0.1}), {0, 0, 0.55}, upright), 0.05, 1e-10);
  EXPECT_NEAR(depth(post, Shape::box({0.1, 1, 1}), {0.19, 0, 0}, upright), 0.01, 1e-10);
  EXPECT_NEAR(depth(post, Shape::sphere(0.2), {0.06, 0.0, 0.1}, upright), 0.24, 1e-10);
  EXPECT_NEAR(depth(Shape::cone(0.1, 0.5), Shape::box({1, 1, 0.1}), {0, 0, 0.59}, upright), 0.01,
              1e-10);
}

TEST(RoundSides, ConcentricOnesHaveAWayOut) {
  const std::vector<Shape> shapes{Shape::cylinder(0.2, 0.3), Shape::cylinder(0.3, 0.01),
                                  Shape::cylinder(0.01, 0.3), Shape::cone(0.2, 0.3),
                                  Shape::box({0.1, 0.2, 0.3})};
  for (const Shape& A : shapes) {
    for (const Shape& B : shapes) {
      const Separation s = separation(A, Pose::Identity(), B, Pose::Identity());
      EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
      EXPECT_LT(s.distance, -0.009);
      EXPECT_LE(s.lower, s.distance);
    }
  }
}

TEST(RoundSides, DegenerateOnesAreAnswered) {
  Rng rng(seed);
  for (const Shape& A : {Shape::cylinder(0.2, 0.0), Shape::cylinder(0.0, 0.2), Shape::cone(0.2, 0),
                         Shape::cone(0.0, 0.2), Shape::cylinder(0, 0), Shape::cone(1e-9, 0.5)}) {
    for (int i = 0; i < 100; ++i) {
      SCOPED_TRACE(of_seed(seed, "pose", i));
      Pose X_WA = Pose::Identity();
      X_WA.linear() = families::rotation(rng);
      X_WA.translation() = families::uniform(rng, 0.0, 0.3) * families::direction(rng);
      const Separation s = separation(A, X_WA, Shape::box({0.3, 0.3, 0.3}), Pose::Identity());
      EXPECT_LE(s.lower, s.distance);
      EXPECT_GE(s.upper, s.distance);
      EXPECT_LT(s.distance, 0.0);
      EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12);
    }
  }
}

}  // namespace round_sides_test
}  // namespace repel
