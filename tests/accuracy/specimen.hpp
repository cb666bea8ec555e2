// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One shape of each kind with its 113-bit support map, and reference values of a posed pair of
/// them: the distance between proven bounds, and in overlap the separating translation along a
/// direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>
#include <support/placed.hpp>
#include <support/wolfe.hpp>

namespace repel::accuracy {

using families::Rng;
using oracle::Point;
using oracle::Real;

/// A shape and the formula of its support map: a core (a polytope, or a set of rings around the z
/// axis) swept by a ball.
struct Specimen {
  /// A circle around the z axis; of radius 0 it is a point.
  struct Ring {
    double radius;  ///< [m]
    double z;       ///< [m]
  };

  std::string kind;
  Shape shape;
  std::vector<Vec3> vertices;  ///< [m] of a polytope, rounded or not
  std::vector<Ring> rings;     ///< used if there are no vertices
  double ball = 0.0;           ///< [m] radius of the ball
  double size = 0.0;           ///< [m] farthest point from the origin

  /// The point of the core farthest along `d`, in the frame of the shape.
  [[nodiscard]] Point farthest_on_rings(const Point& d) const {
    const Real across = oracle::square_root(d.x[0] * d.x[0] + d.x[1] * d.x[1]);
    Point best{};
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const Real scale = across > 0 ? Real(rings[i].radius) / across : Real(0);
      const Point p{{scale * d.x[0], scale * d.x[1], rings[i].z}};
      if (i == 0 || dot(p, d) > dot(best, d)) best = p;
    }
    return best;
  }
  /// [m] Support value along the unit vector `d`, in double.
  [[nodiscard]] double reach_along(const Vec3& d) const {
    double reach = -1e300;
    for (const Vec3& v : vertices) reach = std::max(reach, v.dot(d));
    const double across = std::hypot(d.x(), d.y());
    for (const Ring& r : rings) reach = std::max(reach, r.radius * across + r.z * d.z());
    return reach + ball;
  }
};

/// Kinds in the order of the tables.
inline const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all{
      "box", "hull 4", "hull 16", "hull 100", "hull 1000", "sphere", "capsule", "cylinder", "cone"};
  return all;
}

/// A specimen of that kind, 0.3 to 1 m in size.
inline Specimen make(const std::string& kind, Rng& rng) {
  const double a = families::uniform(rng, 0.2, 0.6);
  const double b = families::uniform(rng, 0.2, 0.6);
  const auto sized = [](Specimen s) {
    for (const Vec3& v : s.vertices) s.size = std::max(s.size, v.norm() + s.ball);
    for (const auto& r : s.rings) s.size = std::max(s.size, std::hypot(r.radius, r.z) + s.ball);
    return s;
  };
  if (kind == "box") {
    const Vec3 half(a, b, families::uniform(rng, 0.2, 0.6));
    return sized({kind, Shape::box(half), families::box(half).vertices, {}, 0.0, 0.0});
  }
  if (kind == "sphere") return sized({kind, Shape::sphere(a), {Vec3::Zero()}, {}, a, 0.0});
  if (kind == "capsule") {
    return sized({kind, Shape::capsule(a, b), {{0, 0, -b}, {0, 0, b}}, {}, a, 0.0});
  }
  if (kind == "cylinder") {
    return sized({kind, Shape::cylinder(a, b), {}, {{a, -b}, {a, b}}, 0.0, 0.0});
  }
  if (kind == "cone") {
    return sized({kind, Shape::cone(a, b), {}, {{a, -b}, {0.0, b}}, 0.0, 0.0});
  }
  const int count = std::stoi(kind.substr(5));  // "hull N"
  const auto vertices = families::cloud(rng, count, a + 0.2).vertices;
  return sized({kind, Shape::hull(vertices, {.levels = 4}), vertices, {}, 0.0, 0.0});
}

/// Two posed specimens.
class PosedPair {
 public:
  PosedPair(const Specimen& A, const Pose& X_WA, const Specimen& B, const Pose& X_WB)
      : A_(A),
        B_(B),
        X_WA_(X_WA),
        X_WB_(X_WB),
        cores_(A.vertices, X_WA, B.vertices, X_WB),
        offset_(oracle::exact(X_WB.translation()) - oracle::exact(X_WA.translation())) {}

  /// The distance while the cores are apart; if they intersect, the lower bound is minus the ball
  /// radii.
  [[nodiscard]] oracle::Bracket distance() {
    const Real balls = Real(A_.ball) + Real(B_.ball);
    const auto support = [this](const Point& x) {
      return farthest(A_, X_WA_, cores_.A, Point{}, Real(-1) * x) -
             farthest(B_, X_WB_, cores_.B, offset_, x);
    };
    oracle::Bracket found = oracle::minimum_norm(support, support(Real(-1) * offset_),
                                                 Real(A_.size) + Real(B_.size), Real(1e-26));
    found.lower -= balls;
    found.upper -= balls;
    return found;
  }

  /// [m] Translation of A along the unit vector `n` that separates it from B: an upper bound of the
  /// depth.
  [[nodiscard]] double overlap_along(const Vec3& n) const {
    const Vec3 between = X_WB_.translation() - X_WA_.translation();
    return n.dot(between) + B_.reach_along(X_WB_.linear().transpose() * n) +
           A_.reach_along(-(X_WA_.linear().transpose() * n));
  }

  /// [m] The least overlap found over directions all around and `hint`: an upper bound of the
  /// depth.
  [[nodiscard]] double depth_by_search(const Vec3& hint, Rng& rng) const {
    std::vector<std::pair<double, Vec3>> starts{{overlap_along(hint), hint}};
    for (int i = 0; i < 300; ++i) {
      const Vec3 n = families::direction(rng);
      starts.emplace_back(overlap_along(n), n);
    }
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(starts.begin() + 1, starts.end(), less);
    double depth = starts[0].first;
    for (int i = 0; i < 4; ++i) depth = std::min(depth, descend(starts[i], rng));
    return depth;
  }

 private:
  static Point farthest(const Specimen& s, const Pose& X, oracle::Placed& core, const Point& offset,
                        const Point& d) {
    if (!s.vertices.empty()) return core.exact(core.farthest(d));
    return oracle::rotated(X, s.farthest_on_rings(oracle::rotated_back(X, d))) + offset;
  }

  /// Random search around the best direction; the step is reduced after a few failures.
  [[nodiscard]] double descend(std::pair<double, Vec3> best, Rng& rng) const {
    for (double step = 0.1; step > 1e-7; step *= 0.6) {
      for (int i = 0; i < 8; ++i) {
        const Vec3 n = (best.second + step * families::direction(rng)).normalized();
        const double overlap = overlap_along(n);
        if (overlap < best.first) best = {overlap, n};
      }
    }
    return best.first;
  }

  const Specimen& A_;
  const Specimen& B_;
  const Pose &X_WA_, &X_WB_;
  oracle::PlacedPair cores_;
  Point offset_;
};

}  // namespace repel::accuracy
