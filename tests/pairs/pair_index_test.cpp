// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_index.hpp>

#include <gtest/gtest.h>

#include <repel/reduction/shape.hpp>
#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_index_test {

constexpr unsigned seed = 905;

TEST(BoxOf, HoldsThePartAndTouchesIt) {
  families::Rng random(seed);
  World world;
  const BodyId body = world.add_body("body");
  const std::vector<Vec3> corners{{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}};
  for (const Shape& shape :
       {Shape::box({0.1, 0.2, 0.3}), Shape::sphere(0.1), Shape::capsule(0.1, 0.2),
        Shape::cylinder(0.1, 0.3), Shape::cone(0.2, 0.1), Shape::hull(corners)}) {
    const PartId id = world.add_part(body, "part", shape, test::random_pose(random, 0.5));
    const Part& part = world.part(id);
    const Box box = box_of(part);
    // A plane far away along an axis is equally far from the box and from the part.
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Pose X = Pose::Identity();
        X.translation() = centre(box);
        X.translation()[axis] = side * 1e4;
        Vec3 half(1e5, 1e5, 1e5);
        half[axis] = 0.0;
        const double gap = separation(shape, part.X_BP, Shape::box(half), X).distance;
        const double reach = side > 0 ? box.max()[axis] : -box.min()[axis];
        EXPECT_NEAR(1e4 - gap, reach, 1e-6);
      }
    }
  }
}

TEST(PairIndex, ListsWithTheSamePartnersShareATree) {
  const test::Boxes boxes(4, 100, {}, seed);
  const PairIndex index(boxes.world);
  EXPECT_EQ(index.body_pairs.size(), 1U);
  EXPECT_EQ(index.lists.size(), 100U);
  EXPECT_EQ(index.trees.size(), 1U);
  EXPECT_EQ(index.pairs.size(), 400U);
}

TEST(PairIndex, TheBodyWhosePartsAreSpreadWiderHasTheListsWhicheverIsNamedFirst) {
  for (const bool wall_first : {false, true}) {
    World world;
    const BodyId tool = world.add_body("tool");
    const PartId part = world.add_part(tool, "part", Shape::sphere(0.1));
    for (int i = 0; i < 5; ++i) {
      Pose X = Pose::Identity();
      X.translation().y() = 0.3 * i;
      const PartId wall = world.add_part(World::fixed, "wall", Shape::sphere(0.1), X);
      world.add_pair(wall_first ? wall : part, wall_first ? part : wall, {});
    }
    const PairIndex index(world);
    ASSERT_EQ(index.body_pairs.size(), 1U);
    EXPECT_EQ(index.body_pairs[0].a, World::fixed);
    EXPECT_EQ(index.lists.size(), 5U);
  }
}

}  // namespace pair_index_test
}  // namespace repel::detail
