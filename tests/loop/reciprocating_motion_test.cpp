// SPDX-License-Identifier: BSD-3-Clause
// Moving obstacles: their position, and the reaction of an arm in their path.
#include <repel/loop/reciprocating_motion.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "loop/slider.hpp"

namespace repel {
namespace reciprocating_motion_test {

TEST(ReciprocatingMotion, IsThereAtHalfTimeAndBackAtTheEndWithTheVelocityOfItsPose) {
  World world;
  MovingBody moving{world.add_body("box"), Pose::Identity(), {Vec3(0.4, 0.0, -0.3), 8.0}};
  moving.X_WB.translation() = Vec3(1.0, 2.0, 3.0);
  const BodyState& state = world.motion().bodies[static_cast<std::size_t>(moving.body.index)];
  const auto offset = [&](double time) {
    EXPECT_TRUE(moving.place(world, time));
    return Vec3(state.X_WB.translation() - moving.X_WB.translation());
  };
  EXPECT_LT(offset(0.0).norm(), 1e-15);
  EXPECT_LT((offset(4.0) - moving.motion.along_W).norm(), 1e-12);
  EXPECT_LT(offset(8.0).norm(), 1e-12);
  constexpr double h = 1e-6;
  double fastest = 0.0;
  for (double time = 0.0; time < 8.0; time += 0.1) {
    const Vec3 before = offset(time - h);
    const Vec3 after = offset(time + h);
    (void)offset(time);
    ASSERT_LT((state.V_WB.linear - (after - before) / (2.0 * h)).norm(), 1e-8);
    fastest = std::max(fastest, state.V_WB.linear.norm());
  }
  EXPECT_NEAR(fastest, moving.motion.top_speed(), 0.01 * moving.motion.top_speed());
  EXPECT_FALSE(moving.place(world, std::numeric_limits<double>::quiet_NaN()));
}

// If the energy delivered by the door were not counted as supplied, the passivity controller of the
// walls would not let them pass it on, and the door would go through the ball.
TEST(ReciprocatingMotion, PushesAnArmAheadOfItAndTheLedgerSaysWhoPaid) {
  test::SliderCell cell({}, {.walls = 0, .door = ReciprocatingMotion{Vec3(0.2, 0.0, 0.0), 4.0}});
  double farthest = 0.0;
  for (int tick = 0; tick < 1600; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_EQ(record.status & ~status::saturated, 0U) << to_text(record.status);
    farthest = std::max(farthest, cell.arm.q[0]);
    ASSERT_GT(record.pairs.nearest, 0.0) << "tick " << tick;
  }
  // 200 mm minus the gap of 30 mm; the hand at the ball resists until it slips.
  EXPECT_GT(farthest, 0.17);
  EXPECT_LT(farthest, 0.19);
  const network::Node& walls = *cell.cell.network(0).node_of<network::Obstacle>();
  EXPECT_GT(walls.ledger.supplied, 0.05);
  EXPECT_LT(walls.ledger.energy, walls.ledger.supplied) << "some of it must have moved the ball";
  EXPECT_LE(walls.ledger.deficit(), 1e-9);
}

}  // namespace reciprocating_motion_test
}  // namespace repel
