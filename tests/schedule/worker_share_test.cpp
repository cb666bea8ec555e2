#include <repel/schedule/worker_share.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel {
namespace worker_share_test {

using namespace std::chrono_literals;
constexpr unsigned seed = 1950;
constexpr ForceLaw reaches_everything{.range = 2.0};

detail::WorkerShare alone(const World& world, const Budget& budget) {
  return {world, std::make_shared<detail::PairIndex>(world), budget, 0, 1};
}

PairTotals totals_of(const detail::WorkerShare& worker) {
  PairTotals totals;
  for (const auto& block : worker.blocks()) totals.add(block.forces().totals);
  return totals;
}

TEST(WorkerShare, TakesEveryStrideThBlockAndAllPairsAreTakenOnce) {
  const test::Boxes boxes(4, 50, {}, seed);  // 200 pairs: three full blocks and one of 8
  const auto pairs = std::make_shared<detail::PairIndex>(boxes.world);
  std::vector<int> owners(200, 0);
  for (int index = 0; index < 3; ++index) {
    const detail::WorkerShare worker(boxes.world, pairs, {}, index, 3);
    for (const auto& block : worker.blocks()) {
      const detail::PairMemory& memory = block.memory();
      EXPECT_EQ(memory.partition().block % 3, index);
      for (int place = 0; place < memory.pairs(); ++place) {
        ++owners[memory.partition().pair_at(place).index];
      }
    }
  }
  for (const int owner : owners) EXPECT_EQ(owner, 1);
}

TEST(WorkerShare, WorldWithoutPairsIsNoTrouble) {
  World world;
  for (const std::int64_t units : {0, 100}) {
    detail::WorkerShare worker = alone(world, {.work_units = units});
    worker.prime(world.motion());
    worker.run(world.motion());
    EXPECT_TRUE(worker.blocks().empty());
  }
}

TEST(WorkerShare, PrimingAsksEveryPairWhateverTheBudget) {
  const test::Boxes boxes(4, 50, reaches_everything, seed);
  detail::WorkerShare worker = alone(boxes.world, {.work_units = 1, .wall = 1ns});
  worker.prime(boxes.world.motion());
  EXPECT_EQ(totals_of(worker).evaluated, 200);
  EXPECT_EQ(totals_of(worker).stale, 0);
}

TEST(WorkerShare, WorkUnitsAreSharedAmongTheBlocks) {
  test::Boxes boxes(4, 64, reaches_everything, seed);  // 256 pairs, 4 blocks
  constexpr std::int64_t units = 200;
  detail::WorkerShare worker = alone(boxes.world, {.work_units = units});
  worker.prime(boxes.world.motion());
  std::int64_t dearest = 0;
  for (int tick = 0; tick < 100; ++tick) {
    boxes.move();
    for (const Pair& pair : boxes.world.pairs()) {
      dearest = std::max<std::int64_t>(dearest, test::separation_now(boxes.world, pair).iterations);
    }
    worker.run(boxes.world.motion());
    const PairTotals totals = totals_of(worker);
    ASSERT_LT(totals.iterations, units + 4 * dearest) << "seed " << seed;
    ASSERT_EQ(totals.evaluated + totals.stale, totals.near);
    ASSERT_LE(totals.oldest_age, detail::PairPartition::run);
    for (const auto& block : worker.blocks()) ASSERT_GE(block.forces().totals.evaluated, 1);
  }
}

TEST(WorkerShare, OneNanosecondIsSpentHonestly) {
  test::Boxes boxes(4, 50, {.range = 2.0, .damping = 0.0}, seed);
  detail::WorkerShare worker = alone(boxes.world, {.wall = 1ns});
  worker.prime(boxes.world.motion());
  for (int tick = 0; tick < 50; ++tick) {
    boxes.move();
    worker.run(boxes.world.motion());
    const PairTotals totals = totals_of(worker);
    ASSERT_EQ(totals.near, 200);
    ASSERT_EQ(totals.evaluated, 0);
    ASSERT_EQ(totals.stale, 200);
    ASSERT_EQ(totals.oldest_age, tick + 1);
    for (const auto& block : worker.blocks()) ASSERT_TRUE(test::is_finite(block.forces()));
  }
}

TEST(WorkerShare, NoBlockStarvesOnAWallBudgetThatIsTooShortForOne) {
  test::Boxes boxes(4, 160, reaches_everything, seed);  // 640 pairs, 8 blocks
  detail::WorkerShare worker = alone(boxes.world, {.wall = 5us});
  worker.prime(boxes.world.motion());
  // Until every answer is newer than the start; how long that takes depends on the machine.
  constexpr int most = 20000;
  int tick = 0;
  bool all_refreshed = false;
  while (!all_refreshed && tick < most) {
    boxes.move();
    worker.run(boxes.world.motion());
    ++tick;
    all_refreshed = totals_of(worker).oldest_age < tick;
  }
  EXPECT_TRUE(all_refreshed) << "after " << tick << " ticks, seed " << seed;
}

TEST(WorkerShare, TenThousandPairsInFiftyMicrosecondsAreReportedStaleAndStayFinite) {
  test::Boxes boxes(4, 2500, reaches_everything, seed);
  detail::WorkerShare worker = alone(boxes.world, {.wall = 50us});
  worker.prime(boxes.world.motion());
  int ticks_with_stale = 0;
  for (int tick = 0; tick < 200; ++tick) {
    boxes.move();
    worker.run(boxes.world.motion());
    const PairTotals totals = totals_of(worker);
    ASSERT_EQ(totals.near, 10000);
    ASSERT_EQ(totals.evaluated + totals.stale, totals.near);
    ticks_with_stale += totals.stale > 0 ? 1 : 0;
    for (const auto& block : worker.blocks()) ASSERT_TRUE(test::is_finite(block.forces()));
  }
  EXPECT_GT(ticks_with_stale, 100);
}

}  // namespace worker_share_test
}  // namespace repel
