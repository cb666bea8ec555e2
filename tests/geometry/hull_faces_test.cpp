// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/hull_faces.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <support/families.hpp>

namespace repel {
namespace hull_faces_test {

TEST(HullFaces, TrianglesInOnePlaneAreOneFace) {
  const std::vector<Vec3> corners = families::box({0.3, 0.2, 0.1}).vertices;
  const std::vector<Facet> facets = hull_facets(corners);
  ASSERT_EQ(facets.size(), 12U);
  EXPECT_EQ(hull_faces(corners, facets, corners).count(), 6U);
}

TEST(HullFaces, NameTheVerticesInTheOrderThatIsGiven) {
  const std::vector<Vec3> points = families::box({0.3, 0.2, 0.1}).vertices;
  std::vector<Vec3> vertices = points;
  std::reverse(vertices.begin(), vertices.end());
  const Faces faces = hull_faces(points, hull_facets(points), vertices);
  ASSERT_EQ(faces.count(), 6U);
  for (std::uint32_t face = 0; face < 6; ++face) {
    const Vec3 n = to_vec3(faces.normal(face));
    for (const std::uint32_t corner : faces.corners(face)) {
      EXPECT_DOUBLE_EQ(dot(n, vertices[corner]), n.cwiseAbs().dot(Vec3(0.3, 0.2, 0.1)));
    }
  }
}

TEST(HullFaces, AFlatHullHasNone) {
  const std::vector<Vec3> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(hull_faces(triangle, hull_facets(triangle), triangle).empty());
}

}  // namespace hull_faces_test
}  // namespace repel
