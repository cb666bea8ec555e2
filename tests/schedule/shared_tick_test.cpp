// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/shared_tick.hpp>

#include <gtest/gtest.h>

#include <thread>

#include "pairs/boxes.hpp"
#include "support/comes_true.hpp"

namespace repel::detail {
namespace shared_tick_test {

constexpr unsigned seed = 2711;

/// All pairs of a world near, shared or evaluated by one thread.
struct Tick {
  explicit Tick(const World& the_world)
      : world(&the_world),
        shared(the_world, static_cast<int>(the_world.pairs().size()), {}, 0.0),
        leader{.poses = PartPoses(the_world), .is_leader = true} {
    shared.pairs().track_all(PairIndex(the_world));
  }
  int select() {
    leader.poses.begin_tick();
    leader.round = ++round;
    shared.pairs().begin_tick(world->motion().tick);
    return shared.pairs().select(world->motion(), leader.poses, {});
  }
  const PairForces& finish() {
    shared.pairs().finish(world->motion(), leader.poses);
    return shared.pairs().forces();
  }

  const World* world;
  SharedTick shared;
  Evaluator leader;
  std::int64_t round = 0;
};

TEST(SharedTick, ForcesHaveTheBitsOfOneThreadAlone) {
  test::Boxes boxes(4, 100, {.range = 2.0}, seed);
  Tick alone(boxes.world), together(boxes.world);
  std::atomic<bool> ends{false};
  std::int64_t taken = 0;
  std::thread helper([&, evaluator = Evaluator{.poses = PartPoses(boxes.world)}]() mutable {
    while (!ends) taken += together.shared.work(evaluator) ? 1 : 0;
  });
  for (int tick = 0; tick < 300; ++tick) {
    boxes.move();
    (void)alone.select();
    alone.shared.pairs().evaluate_all(boxes.world.motion(), alone.leader.poses);
    const PairForces& expected = alone.finish();
    const int batches = together.select();
    ASSERT_GT(batches, 10);
    together.shared.open(together.round, boxes.world.motion(), batches);
    // On a busy machine the other thread may never be in time: the first tick is all its own.
    if (tick > 0) (void)together.shared.work(together.leader);
    ASSERT_TRUE(test::comes_true([&] { return together.shared.is_idle(); }));
    const PairForces& forces = together.finish();
    EXPECT_EQ(forces.totals.evaluated, 400);
    EXPECT_EQ(forces.on_body[1].force, expected.on_body[1].force) << "seed " << seed;
    EXPECT_EQ(forces.on_body[1].torque, expected.on_body[1].torque) << "seed " << seed;
  }
  ends = true;
  helper.join();
  EXPECT_GT(taken, 0) << "the other thread had nothing to do";
}

TEST(SharedTick, NothingIsTakenBeforeItIsOpened) {
  test::Boxes boxes(2, 20, {.range = 2.0}, seed);
  Tick tick(boxes.world);
  EXPECT_TRUE(tick.shared.is_idle());
  EXPECT_FALSE(tick.shared.work(tick.leader));
  const int batches = tick.select();
  EXPECT_FALSE(tick.shared.work(tick.leader));
  tick.shared.open(tick.round, boxes.world.motion(), batches);
  EXPECT_FALSE(tick.shared.is_idle());
  EXPECT_TRUE(tick.shared.work(tick.leader));
  EXPECT_TRUE(tick.shared.is_idle());
  EXPECT_FALSE(tick.shared.work(tick.leader));
}

}  // namespace shared_tick_test
}  // namespace repel::detail
