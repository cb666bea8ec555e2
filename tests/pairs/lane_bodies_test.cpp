#include <repel/pairs/lane_bodies.hpp>

#include <gtest/gtest.h>

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
  PartPoses poses(world);
  poses.begin_tick();
  const LanePose lanes = bodies.poses(poses, world.motion());
  EXPECT_EQ(lanes.columns[3].at(0), Vec3::Zero());
  EXPECT_EQ(lanes.columns[3].at(1), X.translation());
  EXPECT_EQ(bodies.posed(1, poses, world.motion()).X_W.translation(), X.translation());
}

}  // namespace lane_bodies_test
}  // namespace repel::detail
