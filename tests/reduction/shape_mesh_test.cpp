// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/shape_mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel {
namespace mesh_test {

constexpr std::uint64_t seed = 1993;

struct Specimen {
  const char* name;
  Shape shape;
};

std::vector<Specimen> specimens() {
  families::Rng rng(seed);
  const std::vector<Vec3> few = families::cloud(rng, 12, 0.2).vertices;
  const std::vector<Vec3> many = families::cloud(rng, 300, 0.2).vertices;
  return {{"box", Shape::box({0.1, 0.2, 0.3})},
          {"thin box", Shape::box({0.1, 0.2, 1e-4})},
          {"sphere", Shape::sphere(0.2)},
          {"capsule", Shape::capsule(0.1, 0.2)},
          {"long cylinder", Shape::cylinder(0.1, 0.3)},
          {"ellipsoid", Shape::ellipsoid({0.1, 0.3, 0.2})},
          {"flat cylinder", Shape::cylinder(0.3, 0.1)},
          {"cylinder as wide as long", Shape::cylinder(0.2, 0.2)},
          {"cone", Shape::cone(0.1, 0.2)},
          {"flat cone", Shape::cone(0.3, 0.02)},
          {"hull of 12", Shape::hull(few)},
          {"hull of 300", Shape::hull(many)},
          {"prism", Shape::hull(families::prism(7, 0.1, 0.2).vertices)}};
}

/// These have no thickness, or are empty.
std::vector<Specimen> flat_specimens() {
  const std::vector<Vec3> polygon{{0.2, 0, 0},     {0, 0.1, 0}, {-0.2, 0, 0}, {0, -0.1, 0},
                                  {0.05, 0.01, 0}, {0, 0, 0},   {0.2, 0, 0}};
  return {{"rectangle", Shape::box({0.1, 0.2, 0})},
          {"segment", Shape::box({0.1, 0, 0})},
          {"point", Shape::box({0, 0, 0})},
          {"sphere of no radius", Shape::sphere(0)},
          {"capsule of no radius", Shape::capsule(0, 0.2)},
          {"capsule of no length", Shape::capsule(0.2, 0)},
          {"disc", Shape::cylinder(0.2, 0)},
          {"cylinder of no radius", Shape::cylinder(0, 0.2)},
          {"cone of no height", Shape::cone(0.2, 0)},
          {"cone of no radius", Shape::cone(0, 0.2)},
          {"polygon with points inside", Shape::hull(polygon)},
          {"points on a line", Shape::hull(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}})},
          {"one point", Shape::hull(std::vector<Vec3>{{1, 2, 3}})},
          {"the same point", Shape::hull(std::vector<Vec3>(9, Vec3(1, 2, 3)))}};
}

/// [m] of the set that a mesh of this level represents.
double support_value(const Shape& shape, int level, const Vec3& d) {
  const Level& chosen = shape.level(level);
  return chosen.core.support_value(Vec<double>(d)) + (level == 0 ? chosen.depth : 0.0);
}

double support_value(const TriangleMesh& mesh, const Vec3& d) {
  double most = -1e9;
  for (const Vec3& p : mesh.vertices) most = std::max(most, d.dot(p));
  return most;
}

/// Each edge belongs to two triangles, with opposite directions.
void expect_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(t[k], 0);
      ASSERT_LT(t[k], static_cast<int>(mesh.vertices.size()));
      ++edges[{t[k], t[(k + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    ASSERT_NE(back, edges.end()) << edge.first << " to " << edge.second;
    EXPECT_EQ(count, back->second);
  }
}

Vec3 twice_area(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

/// [m^3] Enclosed volume; each triangle must face outward.
double volume_inside(const TriangleMesh& mesh) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : mesh.vertices) middle += p / static_cast<double>(mesh.vertices.size());
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 p = mesh.vertices[static_cast<std::size_t>(t[0])];
    const double part = twice_area(mesh, t).dot(p - middle) / 6.0;
    EXPECT_GE(part, -1e-12);
    volume += part;
  }
  return volume;
}

bool is_polytope(const Shape& shape, int level) {
  return shape.level(level).core.is_polytope() && (level > 0 || shape.level(0).depth == 0.0);
}

/// In every direction the extent equals that of the set, or slightly less where the set is curved.
void expect_outline(const TriangleMesh& mesh, const Shape& shape, int level) {
  families::Rng rng(seed);
  // The half diagonal of a patch of a sphere: 7.5 by 15 degrees, of 15 by 30 at other levels.
  const double chord = is_polytope(shape, level) ? 0.0 : (level == 0 ? 0.012 : 0.048);
  for (int i = 0; i < families::draws(2000); ++i) {
    const Vec3 d = families::direction(rng);
    const double reach = support_value(shape, level, d);
    EXPECT_LE(support_value(mesh, d), reach + 2e-9) << families::of_seed(seed, "direction", i);
    EXPECT_GE(support_value(mesh, d), reach - chord * shape.reach() - 2e-9)
        << families::of_seed(seed, "direction", i);
  }
}

TEST(ShapeMesh, EveryLevelIsAClosedSurfaceWithTheOutlineOfItsSet) {
  for (const Specimen& s : specimens()) {
    for (int level = 0; level < s.shape.levels(); ++level) {
      SCOPED_TRACE(std::string(s.name) + ", level " + std::to_string(level));
      const TriangleMesh mesh = mesh_of(s.shape, level);
      ASSERT_FALSE(mesh.vertices.empty());
      expect_closed(mesh);
      expect_outline(mesh, s.shape, level);
      const double volume = volume_inside(mesh);
      EXPECT_GE(volume, level == 0 ? 1e-6 : 0.0);
    }
  }
}

TEST(ShapeMesh, DeeperLevelsHoldLess) {
  for (const Specimen& s : specimens()) {
    SCOPED_TRACE(s.name);
    double outer = volume_inside(mesh_of(s.shape, 0));
    for (int level = 1; level < s.shape.levels(); ++level) {
      const double inner = volume_inside(mesh_of(s.shape, level));
      EXPECT_LE(inner, outer * 1.0001) << level;
      outer = inner;
    }
  }
}

TEST(ShapeMesh, ABoxHasItsCornersAndTwoTrianglesOnEachFace) {
  const Vec3 h(0.1, 0.2, 0.3);
  const TriangleMesh mesh = mesh_of(Shape::box(h), 0);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  std::set<int> corners;
  for (const Vec3& p : mesh.vertices) {
    EXPECT_EQ(p.cwiseAbs(), h);
    corners.insert((p.x() > 0 ? 1 : 0) + (p.y() > 0 ? 2 : 0) + (p.z() > 0 ? 4 : 0));
  }
  EXPECT_EQ(corners.size(), 8U);
  EXPECT_NEAR(volume_inside(mesh), 8.0 * h.prod(), 1e-12);
}

TEST(ShapeMesh, RoundOnesHaveNearlyTheirVolume) {
  const double pi = 3.14159265358979;
  const auto share = [](const Shape& shape, double volume) {
    return volume_inside(mesh_of(shape, 0)) / volume;
  };
  for (const double r : {share(Shape::sphere(0.2), 4.0 / 3.0 * pi * 0.008),
                         share(Shape::capsule(0.1, 0.2), pi * (0.004 / 3.0 + 0.01 * 0.4)),
                         share(Shape::cylinder(0.1, 0.3), pi * 0.01 * 0.6),
                         share(Shape::cone(0.1, 0.2), pi * 0.01 * 0.4 / 3.0)}) {
    EXPECT_GT(r, 0.96);
    EXPECT_LT(r, 1.0);
  }
}

// Both sides, each of which covers the whole area once.
TEST(ShapeMesh, FlatSetsHaveTwoSidesAndThinnerOnesNone) {
  const std::map<std::string, double> areas{{"rectangle", 0.08},
                                            {"disc", 0.04 * 24 * std::sin(M_PI / 24)},
                                            {"cone of no height", 0.04 * 24 * std::sin(M_PI / 24)},
                                            {"polygon with points inside", 0.04}};
  for (const Specimen& s : flat_specimens()) {
    for (int level = 0; level < s.shape.levels(); ++level) {
      SCOPED_TRACE(std::string(s.name) + ", level " + std::to_string(level));
      const TriangleMesh mesh = mesh_of(s.shape, level);
      ASSERT_FALSE(mesh.vertices.empty());
      for (const Vec3& p : mesh.vertices) EXPECT_TRUE(p.allFinite());
      expect_closed(mesh);
      expect_outline(mesh, s.shape, level);
      double area = 0.0;
      for (const auto& t : mesh.triangles) area += 0.5 * twice_area(mesh, t).norm();
      const auto expected = areas.find(s.name);
      if (level == 0 && expected != areas.end()) {
        EXPECT_NEAR(area, 2.0 * expected->second, 1e-9);
      }
    }
  }
}

// A cylinder that is wider than long is finally reduced to a disc, and then to a point.
TEST(ShapeMesh, ADiscThatIsLeftIsRoundAllAround) {
  const Shape shape = Shape::cylinder(0.3, 0.1);
  const TriangleMesh mesh = mesh_of(shape, shape.levels() - 2);
  double area = 0.0;
  for (const auto& t : mesh.triangles) area += 0.5 * twice_area(mesh, t).norm();
  EXPECT_NEAR(area, 2.0 * 0.04 * 12 * std::sin(M_PI / 12), 1e-9);
}

}  // namespace mesh_test
}  // namespace repel
