// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/held_weight.hpp>

#include <gtest/gtest.h>

#include <array>

namespace repel {
namespace {

TEST(HeldWeight, IsThatOfWhatTheToolHoldsAsFarAsItDoes) {
  World world;
  const BodyId tool = world.add_body("tool", Pose(Eigen::Translation3d(1, 0, 0)));
  world.join(tool, tool);
  const PartId near = world.reserve("near", Shape::sphere(0.1), 0.1);
  const PartId free = world.reserve("free", Shape::sphere(0.1), 0.1);
  for (const PartId part : {near, free}) {
    ASSERT_TRUE(world.add(part, Pose(Eigen::Translation3d(1.5, 0, 0)), 0.0));
  }
  ASSERT_TRUE(world.attach(near, tool, 0.1));
  // Joint 0 lifts the tool, joint 1 turns it about its y axis, which lowers what is ahead of it.
  Jacobian J = Jacobian::Zero(6, 2);
  J(2, 0) = 1.0;
  J(4, 1) = 1.0;
  const auto torques = [&](double mass) {
    std::array<double, 2> out{5.0, 7.0};
    world.weigh(near, mass);
    world.weigh(free, 100.0);
    add_held_weight(world, tool, J, {0, 0, -10}, Masses::known, out);
    return out;
  };
  world.advance(0.05);
  EXPECT_EQ(torques(2.0), (std::array<double, 2>{5.0, 7.0})) << "not yet";
  world.advance(0.05);
  world.advance(0.05);
  world.carry();
  EXPECT_NEAR(torques(2.0)[0], 5.0 + 10.0, 1e-9) << "half of it";
  world.advance(0.1);
  EXPECT_NEAR(torques(2.0)[0], 5.0 + 20.0, 1e-9);
  EXPECT_NEAR(torques(2.0)[1], 7.0 - 0.5 * 20.0, 1e-9);
  EXPECT_EQ(torques(0.0), (std::array<double, 2>{5.0, 7.0}));
  world.weigh(near, 2.0, false);
  std::array<double, 2> out{};
  add_held_weight(world, tool, J, {0, 0, -10}, Masses::known, out);
  EXPECT_EQ(out[0], 0.0) << "the controller does not know it";
  add_held_weight(world, tool, J, {0, 0, -10}, Masses::all, out);
  EXPECT_NEAR(out[0], 20.0, 1e-9);
}

}  // namespace
}  // namespace repel
