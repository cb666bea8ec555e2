// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pairs.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel {
namespace pairs_test {

constexpr unsigned seed = 1993;

TEST(Pairs, ForcesAreThoseOfADirectEvaluationOfEveryPair) {
  test::Boxes boxes(4, 60, {.range = 0.05, .damping = 0.0, .tilt = 0.0}, seed);
  Pairs pairs(boxes.world);
  int near = 0;
  for (int tick = 0; tick < 100; ++tick) {
    boxes.move();
    const PairForces& forces = pairs.exchange();
    Wrench on_tool;
    int apart = 0;
    pairs.for_each_near([&](const NearPair& pair) {
      const Separation s = pairs.separation_of(pair.pair);
      EXPECT_EQ(s.distance, pair.separation.distance);
      apart += s.distance > 0.0 ? 1 : 0;
      on_tool.force += pair.force * s.extraction_W;
    });
    near += apart;
    EXPECT_LE(
        (forces.on_body[static_cast<std::size_t>(boxes.tool.index)].force - on_tool.force).norm(),
        1e-9 * (1.0 + on_tool.force.norm()));
  }
  EXPECT_GT(near, 100) << "seed " << seed;
}

TEST(Pairs, ABudgetIsKeptAndWhatItLeftIsReported) {
  test::Boxes boxes(4, 50, {.range = 2.0, .damping = 0.0}, seed);
  Pairs pairs(boxes.world, {.work_units = 1});
  for (int tick = 0; tick < 20; ++tick) {
    boxes.move();
    const PairForces& forces = pairs.exchange();
    ASSERT_EQ(forces.totals.near, 200);
    ASSERT_LE(forces.totals.evaluated, 1);
    ASSERT_GE(forces.totals.stale, 199);
  }
}

TEST(Pairs, AWorldWithoutPairsHasNoForces) {
  const World world;
  Pairs pairs(world);
  EXPECT_EQ(pairs.exchange().totals.near, 0);
}

}  // namespace pairs_test
}  // namespace repel
