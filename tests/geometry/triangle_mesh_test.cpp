// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/triangle_mesh.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace triangle_mesh_test {

TEST(TriangleMesh, GivesTheCornersOfATriangleInItsOrder) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {3, 1, 0}}};
  EXPECT_EQ(mesh.corners(1), (std::array<Vec3, 3>{{{0, 0, 1}, {1, 0, 0}, {0, 0, 0}}}));
}

}  // namespace triangle_mesh_test
}  // namespace repel
