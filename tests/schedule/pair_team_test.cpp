// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/pair_team.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel {
namespace pair_team_test {

using namespace std::chrono_literals;
constexpr unsigned seed = 1950;
constexpr ForceLaw reaches_everything{.range = 2.0};

/// A leader without threads.
struct Alone {
  explicit Alone(const World& the_world, const Budget& budget = {})
      : world(&the_world),
        team(the_world, std::make_shared<detail::PairIndex>(the_world),
             detail::PartPoses(the_world), with(budget), 0, 0, 0.0) {
    team.prime(world->motion());
  }
  static CoprocessorOptions with(const Budget& budget) {
    CoprocessorOptions options;
    options.budget = budget;
    return options;
  }
  const PairForces& run() {
    EXPECT_FALSE(team.run(world->motion()));
    return team.pairs().forces();
  }
  const World* world;
  detail::PairTeam team;
};

TEST(PairTeam, WorldWithoutPairsIsNoTrouble) {
  const World world;
  for (const std::int64_t units : {0, 100}) {
    Alone alone(world, {.work_units = units});
    EXPECT_EQ(alone.run().totals.near, 0);
  }
}

TEST(PairTeam, PrimingAsksEveryPairWhateverTheBudget) {
  const test::Boxes boxes(4, 50, reaches_everything, seed);
  const Alone alone(boxes.world, {.work_units = 1, .wall = 1ns});
  EXPECT_EQ(alone.team.pairs().forces().totals.evaluated, 200);
  EXPECT_EQ(alone.team.pairs().forces().totals.stale, 0);
}

TEST(PairTeam, OneNanosecondIsSpentHonestly) {
  test::Boxes boxes(4, 50, {.range = 2.0, .damping = 0.0}, seed);
  Alone alone(boxes.world, {.wall = 1ns});
  for (int tick = 0; tick < 50; ++tick) {
    boxes.move();
    const PairForces& forces = alone.run();
    ASSERT_EQ(forces.totals.near, 200);
    ASSERT_EQ(forces.totals.evaluated, 0);
    ASSERT_EQ(forces.totals.stale, 200);
    ASSERT_EQ(forces.totals.oldest_age, tick + 1);
    ASSERT_TRUE(test::is_finite(forces));
  }
}

TEST(PairTeam, NobodyStarvesOnAWallBudgetThatIsTooShortForAll) {
  // The first one in which a machine, busy as it may be, evaluates so many pairs that each of the
  // 640 would have had its turn.
  constexpr std::int64_t enough = 4 * 640;
  for (std::chrono::nanoseconds wall = 5us; wall <= 2ms; wall *= 4) {
    test::Boxes boxes(4, 160, reaches_everything, seed);
    Alone alone(boxes.world, {.wall = wall});
    constexpr int most = 20000;
    int tick = 0;
    std::int64_t evaluated = 0;
    bool all_refreshed = false;  // every answer is newer than the start
    while (!all_refreshed && evaluated < enough && tick < most && (evaluated > 0 || tick < 200)) {
      boxes.move();
      ++tick;
      const PairTotals& totals = alone.run().totals;
      evaluated += totals.evaluated;
      all_refreshed = totals.oldest_age < tick;
    }
    if (!all_refreshed && evaluated < enough) continue;
    EXPECT_TRUE(all_refreshed) << "after " << tick << " ticks, seed " << seed;
    return;
  }
  FAIL() << "too few pairs are evaluated in 2 ms";
}

TEST(PairTeam, TenThousandPairsInFiftyMicrosecondsAreReportedStaleAndStayFinite) {
  test::Boxes boxes(4, 2500, reaches_everything, seed);
  Alone alone(boxes.world, {.wall = 50us});
  int ticks_with_stale = 0;
  for (int tick = 0; tick < 200; ++tick) {
    boxes.move();
    const PairForces& forces = alone.run();
    ASSERT_EQ(forces.totals.near, 10000);
    ASSERT_EQ(forces.totals.evaluated + forces.totals.stale, forces.totals.near);
    ticks_with_stale += forces.totals.stale > 0 ? 1 : 0;
    ASSERT_TRUE(test::is_finite(forces));
  }
  EXPECT_GT(ticks_with_stale, 100);
}

// After a while in which others did the work, pairs have not waited for an evaluation.
TEST(PairTeam, TicksWithoutItDoNotCountAsWaiting) {
  test::Boxes boxes(4, 8, reaches_everything, seed);
  Alone alone(boxes.world, {.work_units = 40, .max_age = 20});
  for (int tick = 0; tick < 100; ++tick) {
    boxes.move();
    EXPECT_EQ(alone.run().totals.expired, 0);
  }
  for (int tick = 0; tick < 100; ++tick) boxes.move();
  alone.team.skip_ticks();
  const PairTotals totals = alone.run().totals;
  EXPECT_GT(totals.stale, 0);
  EXPECT_EQ(totals.expired, 0);
  EXPECT_LE(totals.oldest_age, 1);
}

}  // namespace pair_team_test
}  // namespace repel
