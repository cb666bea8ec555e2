// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/whole_answer.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace whole_answer_test {

constexpr unsigned seed = 77;

/// All pairs of a world, answered now, and widened later.
struct Answered {
  explicit Answered(const World& the_world)
      : world(&the_world),
        made(make_pair_set(the_world, count(), {}, 0.0)),
        set(*made),
        poses(the_world),
        answer(the_world, count()),
        widened(the_world, count()) {
    set.track_all(PairIndex(the_world));
  }
  [[nodiscard]] int count() const { return static_cast<int>(world->pairs().size()); }
  const PairForces& ask() {
    poses.begin_tick();
    set.begin_tick(world->motion().tick);
    (void)set.select(world->motion(), poses, {});
    set.evaluate_all(world->motion(), poses);
    set.finish(world->motion(), poses);
    answer.fill(set, world->motion(), 1);
    return set.forces();
  }
  const World* world;
  std::unique_ptr<AnyPairSet> made;
  AnyPairSet& set;
  PartPoses poses;
  WholeAnswer answer;
  WidenedForces widened;
};

TEST(WholeAnswer, WithoutMotionTheForcesAreThoseThatWereAnswered) {
  test::Boxes boxes(3, 20, {.range = 0.1}, seed);
  Answered answered(boxes.world);
  double most = 0.0;
  for (int tick = 0; tick < 200; ++tick) {
    boxes.move();
    const PairForces& forces = answered.ask();
    answered.widened.widen(answered.answer, boxes.world.motion());
    const PairForces& again = answered.widened.forces();
    for (std::size_t body = 0; body < forces.on_body.size(); ++body) {
      const double size = 1.0 + forces.on_body[body].force.norm();
      ASSERT_LE((again.on_body[body].force - forces.on_body[body].force).norm(), 1e-9 * size);
      ASSERT_LE((again.on_body[body].torque - forces.on_body[body].torque).norm(), 1e-9 * size);
    }
    ASSERT_NEAR(again.totals.peak_force, forces.totals.peak_force, 1e-9 * (1.0 + most));
    most = std::max(most, forces.totals.peak_force);
  }
  EXPECT_GT(most, 10.0) << "seed " << seed;
}

// Apart and in overlap, whatever both bodies do: the distance is a bound.
TEST(WholeAnswer, NoDistanceIsLargerThanTheTrueOne) {
  int apart = 0, overlapping = 0;
  for (unsigned run = 0; run < 200; ++run) {
    // Single points: the mean over a patch may be a little farther than its nearest point.
    const ForceLaw law{.range = 2.0, .surface_force = 100.0, .damping = 0.0, .tilt = 0.0};
    test::Boxes boxes(1, 1, law, seed + run);
    Answered answered(boxes.world);
    const Pair& pair = boxes.world.pairs().front();
    for (int tick = 0; tick < 300; ++tick) {
      boxes.move();
      if (tick % 3 == 0) (void)answered.ask();
      answered.widened.widen(answered.answer, boxes.world.motion());
      const double truth = test::separation_now(boxes.world, pair).distance;
      ASSERT_GE(answered.widened.size(0), pair.law(truth, 0.0) - 1e-9)
          << "tick " << tick << ", seed " << seed + run;
      (truth > 0.0 ? apart : overlapping) += 1;
    }
  }
  EXPECT_GT(apart, 1000);
  EXPECT_GT(overlapping, 500);
}

}  // namespace whole_answer_test
}  // namespace repel::detail
