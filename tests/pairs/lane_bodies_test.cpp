// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/lane_bodies.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace repel::detail {
namespace lane_bodies_test {

TEST(LaneBodies, KnowWhetherTheyAreTheSame) {
  World world;
  const BodyId body = world.add_body("body");
  const Shape box = Shape::box({0.1, 0.2, 0.3});
  Pose X = Pose::Identity();
  X.translation().x() = 0.5;
  const PartId moving = world.add_part(body, "moving", box, X);
  const PartId wall = world.add_part(World::fixed, "wall", box);
  LaneBodies bodies;
  for (int k = 0; k < lane_count; ++k) bodies.set(world, k, wall);
  EXPECT_TRUE(bodies.same_body());
  EXPECT_TRUE(bodies.are_fixed());
  bodies.set(world, 1, moving);
  EXPECT_FALSE(bodies.same_body());
  EXPECT_FALSE(bodies.are_fixed());
  EXPECT_EQ(bodies.body(0), World::fixed);
  EXPECT_EQ(bodies.body(1), body);
}

TEST(LaneBodies, HaveThePosesOfTheirParts) {
  World world;
  const BodyId bodies[] = {world.add_body("tool"), world.add_body("table"), World::fixed};
  const auto turned = [](double angle, const Vec3& p) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(angle, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
    X.translation() = p;
    return X;
  };
  const Shape box = Shape::box({0.1, 0.2, 0.3});
  LaneBodies same, mixed;
  std::vector<PartId> parts;
  for (int k = 0; k < 2 * lane_count; ++k) {
    const BodyId body = k < lane_count ? bodies[0] : bodies[k % 3];
    parts.push_back(world.add_part(body, "part", box, turned(0.3 * k, Vec3(0.1 * k, 0.2, -0.3))));
    (k < lane_count ? same : mixed).set(world, k % lane_count, parts.back());
  }
  world.place(bodies[0], turned(1.0, Vec3(0.5, 0.6, 0.7)), {});
  world.place(bodies[1], turned(2.0, Vec3(-0.5, 0.1, 0.3)), {});
  PartPoses poses(world);
  poses.begin_tick();
  for (int k = 0; k < 2 * lane_count; ++k) {
    const LaneBodies& lanes = k < lane_count ? same : mixed;
    EXPECT_EQ(lanes.same_body(), k < lane_count || lane_count == 1);
    const LanePose X = lanes.poses(world.motion());
    const Pose& wanted = poses.at(parts[static_cast<std::size_t>(k)], world.motion());
    for (int c = 0; c < 4; ++c) {
      const Vec3 off = X.columns[static_cast<std::size_t>(c)].at(k % lane_count) -
                       wanted.matrix().col(c).head<3>();
      EXPECT_LE(off.norm(), 1e-15);
    }
    EXPECT_EQ(lanes.posed(k % lane_count, poses, world.motion()).X_W.matrix(), wanted.matrix());
  }
}

}  // namespace lane_bodies_test
}  // namespace repel::detail
