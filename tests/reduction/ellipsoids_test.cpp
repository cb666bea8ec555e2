// SPDX-License-Identifier: BSD-3-Clause
// Ellipsoids against references that share no code with them: in 113-bit arithmetic, the secular
// equation of a point and Wolfe's algorithm.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/draws.hpp>
#include <support/ellipsoid.hpp>
#include <support/wolfe.hpp>

#include "posed_shapes.hpp"

namespace repel {
namespace ellipsoids_test {

using families::draws;
using families::of_seed;
using families::Rng;
using oracle::Point;
using oracle::Real;

constexpr unsigned seed = 1687;

/// A shape and the 113-bit support map of its core.
struct Body {
  std::string kind;
  Shape shape;
  std::function<Point(const Point&)> farthest;  ///< in the frame of the shape
  Vec3 axes = Vec3::Zero();                     ///< [m] of an ellipsoid
};

Body ellipsoid(const Vec3& axes) {
  const auto farthest = [axes](const Point& d) {
    Point p{{axes.x() * d.x[0], axes.y() * d.x[1], axes.z() * d.x[2]}};
    const Real scale = 1 / oracle::square_root(dot(p, p));
    for (int k = 0; k < 3; ++k) p.x[k] *= scale * axes[k];
    return p;
  };
  return {"ellipsoid", Shape::ellipsoid(axes), farthest, axes};
}

/// 0.05 to 0.2 m long and so many times less thick.
Body random_ellipsoid(Rng& rng, double oblong) {
  const double most = families::uniform(rng, 0.05, 0.2);
  Vec3 axes(most, most * families::log_uniform(rng, 1.0 / oblong, 1.0), most / oblong);
  std::shuffle(axes.data(), axes.data() + 3, rng);
  return ellipsoid(axes);
}

Body random_body(Rng& rng, double oblong) {
  const auto length = [&] { return families::uniform(rng, 0.02, 0.2); };
  const int kind = families::count_between(rng, 0, 5);
  if (kind == 0) {
    const double r = length();
    return {"sphere", Shape::sphere(r), [](const Point&) { return Point{}; }, {}};
  }
  if (kind == 1) {
    const double half = length();
    return {"capsule",
            Shape::capsule(0.5 * length(), half),
            [half](const Point& d) {
              return Point{{0, 0, d.x[2] > 0 ? half : -half}};
            },
            {}};
  }
  if (kind == 2) {
    const double r = length();
    const double half = length();
    const auto farthest = [r, half](const Point& d) {
      const Real across = oracle::square_root(d.x[0] * d.x[0] + d.x[1] * d.x[1]);
      const Real scale = across > 0 ? Real(r) / across : Real(0);
      return Point{{scale * d.x[0], scale * d.x[1], d.x[2] > 0 ? half : -half}};
    };
    return {"cylinder", Shape::cylinder(r, half), farthest, {}};
  }
  if (kind <= 4) {
    const Vec3 half(length(), length(), length());
    const std::vector<Vec3> corners =
        kind == 3 ? families::box(half).vertices : families::cloud(rng, 20, 0.1).vertices;
    const auto farthest = [corners](const Point& d) {
      Point best = oracle::exact(corners[0]);
      for (const Vec3& corner : corners) {
        const Point p = oracle::exact(corner);
        if (dot(p, d) > dot(best, d)) best = p;
      }
      return best;
    };
    return {kind == 3 ? "box" : "hull",
            kind == 3 ? Shape::box(half) : Shape::hull(corners),
            farthest,
            {}};
  }
  return random_ellipsoid(rng, oblong);
}

struct Posed : test::PosedShapes {
  Posed(const Body& a, const Body& b) : PosedShapes{a.shape, b.shape}, of_a(a), of_b(b) {}

  Body of_a, of_b;

  /// The distance, between proven bounds; of the cores if they are rounded.
  [[nodiscard]] oracle::Bracket reference() const {
    const Point between = oracle::exact(X_WB.translation()) - oracle::exact(X_WA.translation());
    const auto support = [&](const Point& x) {
      const Point d_A = oracle::rotated_back(X_WA, Real(-1) * x);
      const Point d_B = oracle::rotated_back(X_WB, x);
      return oracle::rotated(X_WA, of_a.farthest(d_A)) -
             (oracle::rotated(X_WB, of_b.farthest(d_B)) + between);
    };
    return oracle::minimum_norm(support, support(Real(-1) * between), size(), Real(1e-26));
  }
  [[nodiscard]] double rounding() const { return A.level(0).depth + B.level(0).depth; }
  /// Moves B until the shapes are `gap` [m] apart, or less than 0: overlap by at most that much.
  void set_gap(double gap) {
    X_WB.translation() = X_WA.translation() + 4.0 * size() * Vec3(0.6, 0.0, 0.8);
    const oracle::Bracket found = reference();
    const oracle::Rough v = oracle::rough(found.nearest);
    const Vec3 n = Vec3(v.x[0], v.x[1], v.x[2]).normalized();
    X_WB.translation() += (static_cast<double>(found.upper) - rounding() - gap) * n;
  }
  [[nodiscard]] Posed swapped() const {
    Posed other(of_b, of_a);
    other.X_WA = X_WB;
    other.X_WB = X_WA;
    return other;
  }
};

Posed random_pair(Rng& rng, double oblong) {
  Posed pair(random_ellipsoid(rng, oblong), random_body(rng, oblong));
  pair.X_WA = families::random_pose(rng, 0.0, 1.0);
  pair.X_WB.linear() = families::rotation(rng);
  return pair;
}

constexpr double oblongs[] = {1.001, 1.5, 4.0, 30.0, 1e3, 9.9e3};

TEST(Ellipsoids, ApartTheBoundsHoldTheDistanceAndAreNarrow) {
  Rng rng(seed);
  for (const double oblong : oblongs) {
    for (const double gap : {1.0, 0.01, 1e-4, 1e-7, 1e-10}) {
      for (int i = 0; i < draws(25); ++i) {
        Posed pair = random_pair(rng, oblong);
        SCOPED_TRACE(of_seed(seed, pair.of_b.kind.c_str(), i) + ", oblong " + to_text(oblong) +
                     ", gap " + to_text(gap));
        pair.set_gap(gap);
        const oracle::Bracket truth = pair.reference();
        const double distance = static_cast<double>(truth.upper) - pair.rounding();
        ASSERT_LE(static_cast<double>(truth.upper - truth.lower), 1e-18);
        for (const Separation& s : {pair.separate(), pair.swapped().separate()}) {
          EXPECT_EQ(s.end, QueryEnd::converged);
          EXPECT_LE(s.lower, distance + 1e-16);
          EXPECT_GE(s.upper, distance - 1e-16);
          EXPECT_LE(s.upper - s.lower, 1e-14);
          EXPECT_NEAR(s.distance, distance, 4e-15);
        }
      }
    }
  }
}

TEST(Ellipsoids, InASphereOrAroundOneTheDepthIsThatOfItsCentre) {
  Rng rng(seed);
  for (const double oblong : oblongs) {
    for (int i = 0; i < draws(300); ++i) {
      SCOPED_TRACE(of_seed(seed, "pair", i) + ", oblong " + to_text(oblong));
      const Body a = random_ellipsoid(rng, oblong);
      const double radius = families::log_uniform(rng, 1e-3, 0.2);
      const Vec3 p =
          families::uniform(rng, 0.0, 1.5) * a.axes.cwiseProduct(families::direction(rng));
      Pose X_WB = Pose::Identity();
      X_WB.translation() = p;
      const auto outside = oracle::distance_from_ellipsoid(a.axes, oracle::exact(p));
      const double distance = static_cast<double>(outside) - radius;
      const Shape ball = Shape::sphere(radius);
      const Separation s = separation(a.shape, Pose::Identity(), ball, X_WB);
      EXPECT_EQ(s.end, QueryEnd::converged);
      EXPECT_LE(s.lower, distance + 1e-16);
      EXPECT_GE(s.upper, distance - 1e-16);
      const double margin = outside < 0 ? 4.0 * a.shape.planes().margin() : 0.0;
      EXPECT_NEAR(s.distance, distance, margin + 4e-15);
      EXPECT_NEAR(s.distance, separation(ball, X_WB, a.shape, Pose::Identity()).distance,
                  margin + 4e-15);
    }
  }
}

TEST(Ellipsoids, NoPointIsDeeperThanTheDeepest) {
  Rng rng(seed);
  int measured = 0;
  int overlapping = 0;
  for (int i = 0; i < draws(300); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const double oblong = families::log_uniform(rng, 1.0, 100.0);
    Posed pair(random_ellipsoid(rng, oblong), random_ellipsoid(rng, oblong));
    pair.X_WA.linear() = families::rotation(rng);
    pair.X_WB = families::random_pose(rng, 0.0, 0.3 * pair.size());
    WarmStart warm;
    const Separation s = pair.separate(warm);
    if (!(s.distance < -1e-6)) continue;
    ++overlapping;
    const auto depth = [](const Body& body, const Pose& X_WP, const Vec3& x) {
      const Vec3 p = X_WP.inverse() * x;
      return -static_cast<double>(oracle::distance_from_ellipsoid(body.axes, oracle::exact(p)));
    };
    const auto sum_at = [&](const Vec3& x) {
      const double a = depth(pair.of_a, pair.X_WA, x);
      const double b = depth(pair.of_b, pair.X_WB, x);
      return a < 0.0 || b < 0.0 ? -1.0 : a + b;
    };
    if (warm.level_a != WarmStart::deepest_point || s.end != QueryEnd::converged) continue;
    ++measured;
    // The common point is between the witness points, the depth of each from it.
    const double margin = pair.A.planes().margin() + pair.B.planes().margin();
    double deepest = -1.0;
    Vec3 best = s.p_WA;
    for (int k = 0; k <= 20; ++k) {
      const Vec3 x = s.p_WA + k / 20.0 * (s.p_WB - s.p_WA);
      if (sum_at(x) <= deepest) continue;
      deepest = sum_at(x);
      best = x;
    }
    for (int k = 0; k < 20; ++k) {
      const double step = families::log_uniform(rng, 1e-6, 1.0) * pair.size();
      EXPECT_LE(sum_at(best + step * families::direction(rng)), -s.distance + 4.0 * margin);
    }
  }
  EXPECT_GT(overlapping, draws(200));
  EXPECT_GE(measured, overlapping - overlapping / 200);
}

TEST(Ellipsoids, ALittleInTheDepthIsHowFarTheyWereMovedIn) {
  Rng rng(seed);
  for (const double oblong : {1.001, 1.5, 4.0, 30.0}) {
    for (const double deep : {1e-6, 1e-5, 1e-4}) {
      for (int i = 0; i < draws(50); ++i) {
        Posed pair = random_pair(rng, oblong);
        SCOPED_TRACE(of_seed(seed, pair.of_b.kind.c_str(), i) + ", oblong " + to_text(oblong) +
                     ", deep " + to_text(deep));
        pair.set_gap(-deep);
        const Separation s = pair.separate();
        const double margin = pair.A.planes().margin() + pair.B.planes().margin();
        EXPECT_GE(s.distance, -deep - 1e-15) << "no deeper than the way out";
        EXPECT_LE(s.lower, s.distance);
        EXPECT_GE(s.upper, s.distance);
        // The least radius of curvature; where it is not far above the depth, there are shorter
        // ways out.
        const double least = pair.A.reach() / (oblong * oblong);
        if (deep > 0.01 * least || pair.of_b.kind != "ellipsoid") continue;
        EXPECT_LE(s.distance, -deep * (1.0 - 2.0 * deep / least) + 4.0 * margin);
      }
    }
  }
}

TEST(Ellipsoids, ChangeNoFasterThanTheyMoveAndWarmEqualsCold) {
  Rng rng(seed);
  test::Steps seen;
  for (int i = 0; i < draws(30); ++i) {
    const double oblong = families::log_uniform(rng, 1.0, 30.0);
    Posed pair = random_pair(rng, oblong);
    SCOPED_TRACE(of_seed(seed, pair.of_b.kind.c_str(), i) + ", oblong " + to_text(oblong));
    const double margin = pair.A.planes().margin() + pair.B.planes().margin();
    test::expect_smooth_sweep(pair, rng, 8.0 * margin, seen);
  }
  EXPECT_GT(seen.inside, draws(500));
  EXPECT_GT(seen.outside, draws(500));
  EXPECT_LE(seen.cut_short, seen.inside / 200) << "by the levels that stand in, none is wrong";
}

TEST(Ellipsoids, TheLevelsAreNestedByTheirDepths) {
  Rng rng(seed);
  for (int i = 0; i < draws(300); ++i) {
    SCOPED_TRACE(of_seed(seed, "ellipsoid", i));
    const Body body = random_ellipsoid(rng, families::log_uniform(rng, 1.001, 9.9e3));
    const Shape& shape = body.shape;
    EXPECT_EQ(shape.levels(), ReductionOptions().levels + 1);
    EXPECT_EQ(shape.deepest(), body.axes.minCoeff());
    EXPECT_EQ(shape.inscribed_radius(), body.axes.minCoeff());
    EXPECT_EQ(shape.reach(), body.axes.maxCoeff());
    for (int k = 0; k < 40; ++k) {
      const Vec3 n = k < 3 ? Vec3(Vec3::Unit(k)) : families::direction(rng);
      for (int level = 1; level < shape.levels(); ++level) {
        const Level& outer = shape.level(level - 1);
        const Level& inner = shape.level(level);
        EXPECT_LE(inner.core.support_value(Vec<double>(n)) + inner.depth - outer.depth,
                  outer.core.support_value(Vec<double>(n)) + 4e-16 * shape.reach());
      }
    }
  }
}

TEST(Ellipsoids, ByTheLevelsTheBoundsHoldTheDepth) {
  Rng rng(seed);
  for (int i = 0; i < draws(300); ++i) {
    SCOPED_TRACE(of_seed(seed, "pair", i));
    const Body a = random_ellipsoid(rng, families::log_uniform(rng, 1.001, 100.0));
    const double radius = families::log_uniform(rng, 1e-3, 0.2);
    Pose X_WB = Pose::Identity();
    X_WB.translation() =
        families::uniform(rng, 0.0, 1.0) * a.axes.cwiseProduct(families::direction(rng));
    const Point p = oracle::exact(Vec3(X_WB.translation()));
    const double distance =
        static_cast<double>(oracle::distance_from_ellipsoid(a.axes, p)) - radius;
    for (const Measure measure : {Measure::reduction, Measure::exact}) {
      const QueryOptions options{.measure = measure};
      const Separation s =
          separation(a.shape, Pose::Identity(), Shape::sphere(radius), X_WB, options);
      EXPECT_LE(s.lower, distance + 1e-16);
      EXPECT_GE(s.upper, distance - 1e-16);
    }
  }
}

}  // namespace ellipsoids_test
}  // namespace repel
