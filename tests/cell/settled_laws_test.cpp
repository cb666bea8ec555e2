// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/settled_laws.hpp>

#include <gtest/gtest.h>

#include <repel/loop/gain_check.hpp>

#include "cell/sliders.hpp"

namespace repel {
namespace settled_laws_test {

TEST(StoppingDistance, GrowsWithSpeedsDelayAndPeriod) {
  CellDescription cell = test::sliders();
  cell.arms[0].options.tool_speed = 0.2;
  // 0.3 m/s for 5 ms and 3.5 ticks of 2.5 ms, then braked by 2 m/s^2.
  const double alone = stopping_distance(cell);
  EXPECT_NEAR(alone, 0.3 * 0.01375 + 0.0225, 1e-12);
  cell.arms[0].options.drive_delay = 4.0;
  EXPECT_GT(stopping_distance(cell), alone);
  cell.arms[0].options.drive_delay = 0.0;
  cell.obstacles[0].motion = ReciprocatingMotion{{0.1, 0, 0}, 1.0};
  EXPECT_GT(stopping_distance(cell), alone + 0.05);
  cell.obstacles[0].motion = ReciprocatingMotion{{10.0, 0, 0}, 1.0};
  EXPECT_EQ(stopping_distance(cell), 1.0);
}

TEST(SettledLaws, HardWallsAreWatchedFromWhereAnArmStops) {
  CellDescription cell = test::sliders();
  EXPECT_TRUE(settle_laws(cell).empty());
  EXPECT_EQ(cell.obstacles[0].law.watched, 0.0);
  cell.obstacles[0].law.hold = HoldKind::hard;
  EXPECT_TRUE(settle_laws(cell).empty());
  EXPECT_EQ(cell.obstacles[0].law.watched, stopping_distance(cell));
  cell.obstacles[0].law.watched = 0.5;
  (void)settle_laws(cell);
  EXPECT_EQ(cell.obstacles[0].law.watched, 0.5) << "more was asked for";
}

TEST(SettledLaws, DampingIsRaisedForTheTickThatAnswersAreOlderBeside) {
  CellDescription cell = test::sliders();
  ForceLaw& law = cell.obstacles[0].law;
  law.damping = wall_ticks(0.0) / 400.0 * law.stiffness() * 1.01;
  const double given = law.damping;
  EXPECT_TRUE(settle_laws(cell).empty());
  cell.coprocessor.mode = CoprocessorMode::beside;
  cell.coprocessor.threads = 1;
  EXPECT_EQ(wall_delay(cell), 1.0);
  EXPECT_EQ(settle_laws(cell).size(), 1U) << "that of the arm is open";
  EXPECT_GT(law.damping, given);
  EXPECT_GT(cell.arms[0].law.damping, ForceLaw::usual_damping);
}

// Who follows the advice of a check is not told the same number again, as one for threads beside
// that are none.
TEST(SettledLaws, DampingThatIsWhatTheWallNeedsIsRaisedWithoutAWord) {
  CellDescription cell = test::sliders();
  ForceLaw& law = cell.obstacles[0].law;
  for (const double share : {1.0 - 1e-10, 1.0}) {
    law.damping = share * wall_ticks(0.0) / 400.0 * law.stiffness();
    const double given = law.damping;
    EXPECT_TRUE(settle_laws(cell).empty());
    EXPECT_GT(law.damping, given) << "for what scaling rounds";
  }
}

}  // namespace settled_laws_test
}  // namespace repel
