// SPDX-License-Identifier: BSD-3-Clause
// Every level lies inside its shape by its depth, and inside its parent by its step, as the ladder
// states: proven with 113 bits and independently computed planes.
#include <repel/reduction/shape.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <support/families.hpp>
#include <support/polytope.hpp>

namespace repel {
namespace nested_levels_test {

using families::Rng;
using oracle::exact;
using oracle::Point;
using oracle::Real;
using Points = std::vector<Vec3>;

constexpr unsigned seed = 1613;
constexpr double infinite = std::numeric_limits<double>::infinity();

const std::vector<ReductionOptions> all_options{{.levels = 1},
                                                {.levels = 8},
                                                {.levels = 5, .spacing = 0.25},
                                                {.levels = 8, .spacing = 2.0},
                                                {.levels = 20, .spacing = 4.0}};

std::string described(const ReductionOptions& options) {
  return std::to_string(options.levels) + " levels, spacing " + to_text(options.spacing);
}

struct Plane {
  Point n;  ///< unit, outward
  Real offset = 0;

  /// [m] Least depth of a vertex below the plane; candidates are selected in double.
  [[nodiscard]] Real least_depth(const Points& vertices) const {
    const auto roughly = [&](const Vec3& v) { return -dot(oracle::rough(n), oracle::rough(v)); };
    double least = infinite;
    double size = 0.0;
    for (const Vec3& v : vertices) {
      least = std::min(least, roughly(v));
      size = std::max(size, v.norm());
    }
    Real depth = infinite;
    for (const Vec3& v : vertices) {
      if (roughly(v) <= least + 1e-14 * size) depth = std::min(depth, offset - dot(n, exact(v)));
    }
    return depth;
  }
};

Plane plane_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Point n = cross(exact(b) - exact(a), exact(c) - exact(a));
  const Point unit = (1 / oracle::square_root(dot(n, n))) * n;
  return {unit, dot(unit, exact(a))};
}

/// From the faces that the oracle finds by testing all triples of a few vertices.
std::vector<Plane> planes_of_few(const oracle::Polytope& hull) {
  EXPECT_TRUE(hull.closed());
  std::vector<Plane> planes;
  for (const oracle::Face& f : hull.faces()) {
    const auto corner = [&](std::size_t i) { return hull.vertices()[f.corners[i]]; };
    planes.push_back(plane_through(corner(0), corner(1), corner(2)));
  }
  return planes;
}

/// From triangles that are proven to be the hull: no point is above any of them, and they form a
/// closed surface. The vertices may be within rounding of each other.
std::vector<Plane> planes_of_many(const Points& points) {
  std::vector<Plane> planes;
  std::set<int> corners;
  std::map<std::pair<int, int>, int> edges;
  double size = 0.0;
  for (const Vec3& p : points) size = std::max(size, p.norm());
  for (const Facet& f : hull_facets(points)) {
    const auto& [a, b, c] = f.vertices;
    planes.push_back(plane_through(points[a], points[b], points[c]));
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      edges[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
      corners.insert(from);
    }
    EXPECT_GE(planes.back().least_depth(points), Real(-1e-16 * size));
  }
  for (const auto& [edge, sides] : edges) EXPECT_EQ(sides, 0);
  if (planes.empty()) return planes;
  EXPECT_EQ(corners.size() + planes.size(), edges.size() + 2);
  return planes;
}

Points vertices_of(const Convex& core) {
  Points vertices;
  for (int i = 0; i < core.vertex_count(); ++i) {
    vertices.push_back(to_vec3(core.point(static_cast<std::uint32_t>(i)).p));
  }
  return vertices;
}

/// [m] Least depth of a vertex of the level below any plane.
Real least_depth(const std::vector<Plane>& planes, const Level& level) {
  Real least = infinite;
  const Points vertices = vertices_of(level.core);
  for (const Plane& p : planes) least = std::min(least, p.least_depth(vertices));
  return least;
}

void expect_a_ladder(const Shape& shape) {
  EXPECT_EQ(shape.level(shape.levels() - 1).core.vertex_count(), 1) << "the last level is no point";
  for (int i = 1; i < shape.levels(); ++i) {
    EXPECT_GT(shape.level(i).order, shape.level(i - 1).order) << "level " << i;
    EXPECT_GE(shape.level(i).depth, shape.level(i - 1).depth) << "level " << i;
  }
}

void expect_hull_is_nested(const Points& points, const ReductionOptions& options) {
  const Shape shape = Shape::hull(points, options);
  expect_a_ladder(shape);
  const bool few = points.size() <= oracle::Polytope::most;
  const std::vector<Plane> planes =
      few ? planes_of_few(oracle::Polytope(points)) : planes_of_many(points);
  for (int i = 1; i < shape.levels(); ++i) {
    SCOPED_TRACE("level " + std::to_string(i) + " of " + described(options));
    const Level& level = shape.level(i);
    const Level& parent = shape.level(i - 1);
    EXPECT_LE(level.core.vertex_count(), parent.core.vertex_count());
    EXPECT_GE(least_depth(planes, level), level.depth);
    if (i == 1) continue;
    const std::vector<Plane> around = planes_of_many(vertices_of(parent.core));
    EXPECT_GE(least_depth(around, level), Real(level.depth) - parent.depth);
  }
}

TEST(NestedLevels, OfHullsLieAsDeepAsTheySay) {
  Rng rng(seed);
  int solid = 0;
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", hull " + std::to_string(i));
    Points points = families::cloud(rng, 16, families::log_uniform(rng, 1e-3, 1e3)).vertices;
    const double thin = families::log_uniform(rng, 1e-4, 1e-1);
    const Mat3 R = families::rotation(rng);
    const Vec3 away = (i % 2 == 0 ? 0.0 : 2.0) * points[0];
    for (Vec3& p : points) {
      if (i % 3 == 1) p.z() *= thin;                                // a plate
      if (i % 3 == 2) p = Vec3(thin * p.x(), thin * p.y(), p.z());  // a needle
      p = R * p + away;
    }
    const ReductionOptions options = all_options[i / 3 % all_options.size()];
    expect_hull_is_nested(points, options);
    solid += Shape::hull(points, options).deepest() > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(solid, 30);
}

TEST(NestedLevels, OfAThousandVerticesLieAsDeepAsTheySay) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Points points = families::cloud(rng, 1000, 0.3).vertices;
  expect_hull_is_nested(points, {.levels = 4});
  EXPECT_GT(Shape::hull(points, {.levels = 4}).deepest(), 0.25);
}

/// [m] extent along +x, along +z and along -z.
struct Extents {
  Real radius, top, bottom;
};
Extents extents(const Convex& core) {
  const auto along = [&](const Vec3& axis) { return to_vec3(core.support(Vec<double>(axis)).p); };
  return {Real(along(Vec3::UnitX()).x()), Real(along(Vec3::UnitZ()).z()),
          -Real(along(-Vec3::UnitZ()).z())};
}

constexpr double rounding =
    4e-15;  ///< relative to the reach, accuracy of the depths of closed forms

TEST(NestedLevels, OfBoxesAndCylindersLieAsDeepAsTheySay) {
  Rng rng(seed);
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", shape " + std::to_string(i));
    const double a = families::log_uniform(rng, 1e-6, 1e3);
    const double b = i % 4 == 0 ? a : families::log_uniform(rng, 1e-6, 1e3);
    const ReductionOptions options = all_options[i / 2 % all_options.size()];
    const Shape shape =
        i % 2 == 0 ? Shape::box({a, 2.0 * a, b}, options) : Shape::cylinder(a, b, options);
    expect_a_ladder(shape);
    EXPECT_EQ(shape.deepest(), std::min(a, b));
    for (int k = 1; k < shape.levels(); ++k) {
      const Extents inner = extents(shape.level(k).core);
      for (const int outer_level : {0, k - 1}) {
        const Extents outer = extents(shape.level(outer_level).core);
        const Real depth = Real(shape.level(k).depth) - shape.level(outer_level).depth;
        EXPECT_LE(inner.radius + depth - outer.radius, rounding * shape.reach());
        EXPECT_LE(inner.top + depth - outer.top, rounding * shape.reach());
      }
    }
  }
}

TEST(NestedLevels, OfConesLieAsDeepAsTheySay) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", cone " + std::to_string(i));
    const double radius = families::log_uniform(rng, 1e-3, 1.0);
    const double half_length = families::log_uniform(rng, 1e-3, 1.0);
    const Shape shape = Shape::cone(radius, half_length, all_options[i % all_options.size()]);
    expect_a_ladder(shape);
    const Real length = 2 * Real(half_length);
    const Real side = oracle::square_root(length * length + Real(radius) * radius);
    const auto along_side = [&](const Extents& e) {
      return std::max(length * e.radius - radius * e.bottom, radius * e.top) / side;
    };
    const Real inscribed = length * radius / (side + radius);
    EXPECT_NEAR(shape.deepest(), static_cast<double>(inscribed), rounding * shape.reach());
    for (int k = 1; k < shape.levels(); ++k) {
      const Extents inner = extents(shape.level(k).core);
      for (const int outer_level : {0, k - 1}) {
        const Extents outer = extents(shape.level(outer_level).core);
        const Real depth = Real(shape.level(k).depth) - shape.level(outer_level).depth;
        EXPECT_LE(inner.bottom + depth - outer.bottom, rounding * shape.reach());
        EXPECT_LE(along_side(inner) + depth - along_side(outer), rounding * shape.reach());
      }
    }
  }
}

TEST(NestedLevels, OfEveryShapeOfTheFigureEndInAPoint) {
  Rng rng(seed);
  Points flat = families::cloud(rng, 12, 0.5).vertices;
  for (Vec3& p : flat) p.z() = 0.1;
  Points needle = families::cloud(rng, 12, 0.5).vertices;
  for (Vec3& p : needle) p = Vec3(1e-5 * p.x(), 1e-5 * p.y(), p.z());
  const Points line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  for (const ReductionOptions& options : all_options) {
    SCOPED_TRACE(described(options));
    const std::pair<std::string, Shape> shapes[] = {
        {"cube", Shape::box({0.2, 0.2, 0.2}, options)},
        {"long box", Shape::box({0.1, 0.1, 1.0}, options)},
        {"box", Shape::box({0.1, 0.3, 0.7}, options)},
        {"sphere", Shape::sphere(0.3, options)},
        {"cylinder", Shape::cylinder(0.1, 0.5, options)},
        {"disk", Shape::cylinder(0.5, 0.05, options)},
        {"capsule", Shape::capsule(0.1, 0.5, options)},
        {"cone", Shape::cone(0.2, 0.4, options)},
        {"hull", Shape::hull(families::cloud(rng, 20, 0.5).vertices, options)},
        {"needle", Shape::hull(needle, options)},
        {"flat hull", Shape::hull(flat, options)},
        {"flat disk", Shape::cylinder(0.5, 0.0, options)},
        {"flat cone", Shape::cone(0.5, 0.0, options)},
        {"line", Shape::hull(line, options)},
        {"point", Shape::hull(std::span(line).first(1), options)}};
    for (const auto& [name, shape] : shapes) {
      SCOPED_TRACE(name);
      expect_a_ladder(shape);
      const bool has_thickness = name.find("flat") != 0 && name != "line" && name != "point";
      EXPECT_EQ(shape.deepest() > 0.0, has_thickness);
    }
  }
}

}  // namespace nested_levels_test
}  // namespace repel
