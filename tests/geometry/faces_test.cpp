// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/faces.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <repel/geometry/facets.hpp>
#include <repel/geometry/hull_faces.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel {
namespace faces_test {

Faces faces_of(const std::vector<Vec3>& points) {
  return hull_faces(points, hull_facets(points), points);
}

TEST(Faces, OfABoxAreSixRectangles) {
  const std::vector<Vec3> corners = families::box({0.3, 0.2, 0.1}).vertices;
  const Faces faces = faces_of(corners);
  std::set<std::uint32_t> all;
  for (std::uint32_t vertex = 0; vertex < 8; ++vertex) {
    EXPECT_EQ(faces.at(vertex).size(), 3U);
    for (const Faces::Corner& corner : faces.at(vertex)) all.insert(corner.face);
  }
  ASSERT_EQ(all.size(), 6U);
  for (const std::uint32_t face : all) {
    const auto around = faces.corners(face);
    ASSERT_EQ(around.size(), 4U);
    const Vec3 n = to_vec3(faces.normal(face));
    for (std::size_t k = 0; k < 4; ++k) {
      // Counter-clockwise seen from outside.
      const Vec3 here = corners[around[(k + 1) % 4]] - corners[around[k]];
      const Vec3 next = corners[around[(k + 2) % 4]] - corners[around[(k + 1) % 4]];
      EXPECT_GT(here.cross(next).dot(n), 0.0);
    }
  }
}

// Every face supports the hull, and has each of its vertices in its plane.
TEST(Faces, OfAnyHullSupportIt) {
  constexpr unsigned seed = 31;
  families::Rng rng(seed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "hull", i));
    const Shape hull =
        Shape::hull(families::cloud(rng, families::count_between(rng, 4, 400), 0.5).vertices);
    const Convex& core = hull.level(0).core;
    const std::uint32_t vertex = core.support(Vec<double>(families::direction(rng))).name;
    EXPECT_GE(core.faces().at(vertex).size(), 3U);
    for (const auto& [face, next, previous] : core.faces().at(vertex)) {
      const Vec<double>& n = core.faces().normal(face);
      for (const std::uint32_t corner : core.faces().corners(face)) {
        EXPECT_NEAR(dot(core.place(corner), n), core.support_value(n), 1e-12);
      }
    }
  }
}

TEST(Faces, FlatHullsHaveNone) {
  const Faces faces = faces_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_TRUE(faces.empty());
  EXPECT_TRUE(faces.at(2).empty());
  EXPECT_EQ(faces.bytes(), 0U);
}

}  // namespace faces_test
}  // namespace repel
