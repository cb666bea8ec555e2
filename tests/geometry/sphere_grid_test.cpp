// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/sphere_grid.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <support/families.hpp>

namespace repel {
namespace sphere_grid_test {

using families::Rng;

constexpr unsigned seed = 2611;

TEST(SphereGrid, HasANodeNearEveryDirection) {
  Rng rng(seed);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 d = families::log_uniform(rng, 1e-100, 1e100) * families::direction(rng);
    const std::uint32_t name = SphereGrid::nearest(Vec<double>(d));
    ASSERT_LT(name, SphereGrid::size);
    const Vec3 node = to_vec3(SphereGrid::node(name));
    const double sine = node.cross(d.normalized()).norm() / node.norm();
    ASSERT_GT(node.dot(d.normalized()), 0.0);
    EXPECT_LE(0.5 * sine * sine, SphereGrid::sagitta) << families::of_seed(seed, "direction", i);
  }
}

TEST(SphereGrid, FindsItsNodesAgain) {
  Rng rng(seed);
  for (int i = 0; i < 100000; ++i) {
    const auto name = static_cast<std::uint32_t>(rng() % SphereGrid::size);
    const Vec<double> node = SphereGrid::node(name);
    const Vec3 again = to_vec3(SphereGrid::node(SphereGrid::nearest(3.7 * node)));
    EXPECT_LE((again - to_vec3(node)).norm(), 1e-15) << families::of_seed(seed, "node", i);
  }
}

TEST(SphereGrid, TheAxesAreNodes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const Vec3 d = side * Vec3::Unit(axis);
      EXPECT_EQ(to_vec3(SphereGrid::node(SphereGrid::nearest(Vec<double>(d)))), d);
    }
  }
}

TEST(SphereGrid, AnythingHasANode) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double far = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, none, far, -far, 1e308, 1e-320}) {
    for (const Vec3& d : {Vec3(x, x, x), Vec3(1, x, 0), Vec3(x, 0, 1), Vec3(0, 1, x)}) {
      EXPECT_LT(SphereGrid::nearest(Vec<double>(d)), SphereGrid::size) << d.transpose();
    }
  }
  for (const std::uint32_t name : {SphereGrid::size, 0xFFFFFFFFU, 0x80000000U}) {
    const double length = to_vec3(SphereGrid::node(name)).norm();
    EXPECT_TRUE(length >= 1.0 && length <= 1.7321) << name;
  }
}

}  // namespace sphere_grid_test
}  // namespace repel
