// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/part_poses.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace part_poses_test {

constexpr unsigned seed = 77;

TEST(PartPoses, AreThoseOfTheMotionAskedFor) {
  test::Boxes boxes(3, 2, {}, seed);
  PartPoses poses(boxes.world);
  for (int tick = 0; tick < 20; ++tick) {
    boxes.move();
    poses.begin_tick();
    for (std::int32_t i = 0; i < 5; ++i) {
      const Pose expected = test::pose_of(boxes.world, {i});
      const Pose first = poses.at({i}, boxes.world.motion());
      EXPECT_LE((first.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-15)
          << "seed " << seed;
      EXPECT_EQ(poses.at({i}, boxes.world.motion()).matrix(), first.matrix());
      EXPECT_EQ(poses.last({i}).matrix(), first.matrix());
    }
  }
}

TEST(PartPoses, WhatIsNotAskedForStaysWhereItWas) {
  test::Boxes boxes(1, 1, {}, seed);
  PartPoses poses(boxes.world);
  const Pose before = poses.at({0}, boxes.world.motion());
  boxes.move();
  poses.begin_tick();
  EXPECT_EQ(poses.last({0}).matrix(), before.matrix());
}

}  // namespace part_poses_test
}  // namespace repel::detail
