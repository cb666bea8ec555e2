// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/near_pair.hpp>

#include <gtest/gtest.h>

#include <map>

#include <repel/schedule/coprocessor.hpp>

#include "pairs/boxes.hpp"

namespace repel {
namespace near_pair_test {

constexpr unsigned seed = 1993;

std::map<int, NearPair> near_pairs(const Coprocessor& coprocessor) {
  std::map<int, NearPair> seen;
  coprocessor.for_each_near([&](const NearPair& near) {
    EXPECT_TRUE(seen.emplace(near.pair.index, near).second) << "pair " << near.pair.index;
  });
  return seen;
}

// The data for the display are those used by the tick: their sum is the force on the tool.
TEST(NearPair, TheListHasEveryPairThatPushesAndItsForce) {
  for (const int threads : {0, 2}) {
    // At single points: the force of a patch is not quite along the extraction direction.
    test::Boxes boxes(4, 80, {.range = 0.05, .damping = 0.0, .tilt = 0.0}, seed);
    CoprocessorOptions options;
    options.threads = threads;
    options.lock_step = true;
    Coprocessor coprocessor(boxes.world, options);
    int pushing = 0;
    for (int tick = 0; tick < 120; ++tick) {
      SCOPED_TRACE(families::of_seed(seed, "tick", tick));
      boxes.move();
      const PairForces& forces = coprocessor.exchange();
      Vec3 sum = Vec3::Zero();
      const auto seen = near_pairs(coprocessor);
      for (const auto& [index, near] : seen) {
        EXPECT_FALSE(near.stale);
        EXPECT_EQ(near.age, 0);
        sum += near.force * near.separation.extraction_W;
        pushing += near.force > 0.0 ? 1 : 0;
      }
      EXPECT_LE((sum - forces.on_body[boxes.tool.index].force).norm(), 1e-9);
      for (std::size_t i = 0; i < boxes.world.pairs().size(); ++i) {
        const Pair& pair = boxes.world.pairs()[i];
        const Separation now = test::separation_now(boxes.world, pair);
        if (now.distance >= pair.law.range) continue;
        const auto found = seen.find(static_cast<int>(i));
        ASSERT_NE(found, seen.end()) << "pair " << i;
        EXPECT_NEAR(found->second.separation.distance, now.distance, 1e-9);
      }
    }
    EXPECT_GT(pushing, 120) << "seed " << seed;
  }
}

TEST(NearPair, PairsThatWaitForAnAnswerAreMarkedWithTheirAge) {
  test::Boxes boxes(4, 80, {.range = 0.05}, seed);
  CoprocessorOptions options;
  options.budget.work_units = 10;
  Coprocessor coprocessor(boxes.world, options);
  std::int64_t stale_in_all = 0;
  for (int tick = 0; tick < 120; ++tick) {
    SCOPED_TRACE(families::of_seed(seed, "tick", tick));
    boxes.move();
    const PairTotals totals = coprocessor.exchange().totals;
    int stale = 0;
    std::int64_t oldest = 0;
    double peak = 0.0;
    for (const auto& [index, near] : near_pairs(coprocessor)) {
      stale += near.stale ? 1 : 0;
      EXPECT_EQ(near.age > 0, near.stale);
      oldest = std::max(oldest, near.age);
      peak = std::max(peak, near.force);
    }
    EXPECT_EQ(stale, totals.stale);
    EXPECT_EQ(oldest, totals.oldest_age);
    EXPECT_EQ(peak, totals.peak_force);
    stale_in_all += stale;
  }
  EXPECT_GT(stale_in_all, 100) << "the budget is meant to bind, seed " << seed;
}

}  // namespace near_pair_test
}  // namespace repel
