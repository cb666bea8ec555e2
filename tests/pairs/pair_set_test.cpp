// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_set.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel {
namespace pair_set_test {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();
constexpr auto no_deadline = Clock::time_point::max();
constexpr unsigned seed = 4008;

/// Every pair of a small world, all of them candidates.
struct AllPairs {
  explicit AllPairs(const World& the_world)
      : world(&the_world), poses(the_world), set(the_world, pairs()) {
    for (std::int32_t i = 0; i < pairs(); ++i) {
      (void)set.take({i}, 0, 0.0, world->motion(), poses);
    }
    set.end(0);
  }
  const PairForces& run(std::int64_t units = no_limit, Clock::time_point deadline = no_deadline) {
    poses.begin_tick();
    set.begin_tick(world->motion().tick);
    set.select(world->motion(), poses, {deadline, units});
    set.evaluate_all(world->motion(), poses);
    set.finish(world->motion(), poses);
    return set.forces();
  }
  [[nodiscard]] int pairs() const { return static_cast<int>(world->pairs().size()); }

  const World* world;
  detail::PartPoses poses;
  detail::PairSet set;
};

/// A tool and a wall, both movable, that touch at one known point.
struct TwoBodies {
  World world;
  BodyId a, b;

  explicit TwoBodies(double watched = 0.0) {
    a = world.add_body("a");
    b = world.add_body("b");
    Pose X_AP = Pose::Identity();
    X_AP.translation() = Vec3(0.0, 0.0, 0.3);
    const PartId ball = world.add_part(a, "ball", Shape::sphere(0.1), X_AP);
    const PartId wall = world.add_part(b, "wall", Shape::box({1.0, 1.0, 0.1}));
    world.add_pair(ball, wall,
                   {.range = 0.02,
                    .surface_force = 100.0,
                    .damping = 50.0,
                    .hold = watched > 0.0 ? HoldKind::hard : HoldKind::soft,
                    .watched = watched});
  }
};

/// If two plates intersect, the deepest point is not unique, and the one found depends on the last
/// tick.
bool has_one_deepest_point(const World& world, const detail::PairSet& set) {
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
    const Separation now = test::separation_now(world, world.pair({i}));
    const Separation then = set.separation_of({i});
    if (!(now.distance < 0.0)) continue;
    EXPECT_NEAR(then.distance, now.distance, 1e-12);
    EXPECT_LE((then.extraction_W - now.extraction_W).norm(), 1e-9);
    if ((then.p_WA - now.p_WA).norm() > 1e-11) return false;
  }
  return true;
}

// Hard walls made a tick up to eight times as dear: it evaluated every pair within the stopping
// distance. Only the direction of a far pair is needed.
TEST(PairSet, AWatchedPairIsKnownWithoutAnEvaluationInEachTick) {
  TwoBodies watched(0.3), soft;
  AllPairs of_watched(watched.world), of_soft(soft.world);
  int far = 0, evaluated = 0;
  Pose X_WB = Pose::Identity();
  for (int tick = 0; tick < 480; ++tick) {
    X_WB.translation() = Vec3(0.0, 0.0, 0.4 - 1e-3 * tick);  // the gap is 0.5 m less 1 mm a tick
    for (TwoBodies* each : {&watched, &soft}) {
      ASSERT_TRUE(each->world.place(each->a, X_WB, {}));
      each->world.motion().tick = tick;
    }
    const PairForces& forces = of_watched.run();
    int near = 0;
    of_watched.set.for_each_near(watched.world.motion(), [&](const NearPair& pair) {
      ++near;
      EXPECT_NEAR(pair.separation.extraction_W.z(), 1.0, 1e-9);
      EXPECT_EQ(pair.age, 0);
      EXPECT_EQ(pair.is_watched, pair.stale);
    });
    const double gap = 0.5 - 1e-3 * tick;
    EXPECT_TRUE(near == 1 || gap > 0.319) << gap << " m";
    EXPECT_EQ(forces.totals.peak_force, of_soft.run().totals.peak_force) << gap << " m";
    EXPECT_EQ(forces.totals.stale, 0);
    if (gap > 0.32 || gap < 0.02) continue;
    ++far;
    evaluated += forces.totals.evaluated;
  }
  EXPECT_GE(far, 150);
  EXPECT_LT(evaluated, far / 4);
}

TEST(PairSet, ForcesEqualADirectEvaluationOfEveryPair) {
  double peak = 0.0;
  std::int64_t skipped = 0;
  int compared = 0;
  for (unsigned run = 0; run < 3; ++run) {
    test::Boxes boxes(4, 8, {.range = 0.03}, seed + run);
    AllPairs all(boxes.world);
    all.run();
    for (int tick = 0; tick < 1500; ++tick) {
      boxes.move();
      const PairForces& forces = all.run();
      const auto direct = test::forces_now(boxes.world);
      const bool comparable = has_one_deepest_point(boxes.world, all.set);
      compared += comparable ? 1 : 0;
      for (std::size_t body = 0; body < direct.size() && comparable; ++body) {
        ASSERT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-9)
            << "tick " << tick << ", seed " << seed + run;
        ASSERT_LE((forces.on_body[body].torque - direct[body].torque).norm(), 1e-9)
            << "tick " << tick << ", seed " << seed + run;
      }
      ASSERT_EQ(forces.totals.near, forces.totals.evaluated);
      ASSERT_EQ(forces.totals.stale, 0);
      skipped += all.pairs() - forces.totals.near;
      peak = std::max(peak, forces.totals.peak_force);
    }
  }
  // The sample is meaningful: forces occurred, and most evaluations were skipped.
  EXPECT_GT(compared, 3 * 1500 * 9 / 10);
  EXPECT_GT(peak, 50.0);
  EXPECT_GT(skipped, 3 * 1500 * 32 / 2);
}

TEST(PairSet, PassablePairIsPushedAsItsPassageSaysAndNeverJumps) {
  const ForceLaw law{.range = 0.02, .surface_force = 60.0, .ceiling = 12.0, .passable = true};
  test::Boxes boxes(1, 1, law, seed);
  const Pair& pair = boxes.world.pairs().front();
  const Shape& tool = boxes.world.part(pair.a).shape;
  const Shape& obstacle = boxes.world.part(pair.b).shape;
  const Pose X_WB = test::pose_of(boxes.world, pair.b);
  AllPairs all(boxes.world);
  Passage passage;
  Vec3 last = all.run().on_body[boxes.tool.index].force;
  double last_travel = 0.0;
  int pushed = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    boxes.move();
    // Kept near the obstacle, at rest, since a velocity would only add damping.
    const Vec3 p_BT_W = boxes.X_WT.translation() - X_WB.translation();
    boxes.X_WT.translation() = X_WB.translation() + std::min(1.0, 0.12 / p_BT_W.norm()) * p_BT_W;
    boxes.world.place(boxes.tool, boxes.X_WT, {});
    const Vec3 f = all.run().on_body[boxes.tool.index].force;
    const Pose X_WA = test::pose_of(boxes.world, pair.a);
    const Separation s = test::separation_now(boxes.world, pair);
    const double travel = boxes.world.motion().bodies[boxes.tool.index].travel;
    int iterations = 0;
    const double slope = slope_of(s, {tool, X_WA}, {obstacle, X_WB}, {}, {}, iterations);
    const Vec3 expected =
        s.distance < law.range
            ? passage.force(pair.law, s.distance, slope * s.extraction_W, travel, Vec3::Zero())
            : Vec3(Vec3::Zero());
    ASSERT_LE((f - expected).norm(), 1e-4) << "tick " << tick << ", seed " << seed;
    ASSERT_LE((f - last).norm(), 1.0001 * law.stiffness() * (travel - last_travel) + 1e-9);
    pushed += f.norm() > 1.0 ? 1 : 0;
    last = f;
    last_travel = travel;
  }
  EXPECT_GT(pushed, 400);
}

TEST(PairSet, PairsThatCannotBeInRangeCostNothing) {
  World world;
  const BodyId tool = world.add_body("tool");
  const PartId part = world.add_part(tool, "part", Shape::sphere(0.1));
  Pose far = Pose::Identity();
  far.translation().x() = 2.0;
  const PartId wall = world.add_part(World::fixed, "wall", Shape::sphere(0.1), far);
  world.add_pair(part, wall, {.range = 0.02});
  AllPairs all(world);
  EXPECT_EQ(all.run().totals.evaluated, 1);
  Pose X = Pose::Identity();
  int evaluated = 0;
  for (int i = 0; i < 178; ++i) {  // 1.78 m: the clearance
    X.translation().x() += 0.01;
    world.place(tool, X, {});
    if (i < 170) {
      EXPECT_EQ(all.run().totals.iterations, 0) << "after " << X.translation().x();
    }
    evaluated += all.run().totals.evaluated;
  }
  EXPECT_GT(evaluated, 0);  // and it is evaluated in time
}

TEST(PairSet, PairThatTurnsAboutWhereItIsNearestIsNotAsked) {
  World world;
  const BodyId tool = world.add_body("tool");
  // The ball is at the origin of a large body: its rotation hardly moves the ball.
  const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.1));
  Pose out = Pose::Identity();
  out.translation().x() = 1.0;
  world.add_part(tool, "arm", Shape::sphere(0.1), out);
  Pose below = Pose::Identity();
  below.translation().z() = -0.225;  // 25 mm from the ball
  const PartId wall = world.add_part(World::fixed, "wall", Shape::box({1.0, 1.0, 0.1}), below);
  world.add_pair(ball, wall, {.range = 0.02});
  AllPairs all(world);
  EXPECT_EQ(all.run().totals.evaluated, 1);
  Pose X = Pose::Identity();
  for (int i = 1; i <= 100; ++i) {
    X.linear() = Eigen::AngleAxisd(0.02 * i, Vec3(1.0, 2.0, 0.0).normalized()).toRotationMatrix();
    world.place(tool, X, {});
    EXPECT_EQ(all.run().totals.evaluated, 0) << "after " << 0.02 * i << " rad";
  }
  X.translation().z() = -0.006;
  world.place(tool, X, {});
  EXPECT_EQ(all.run().totals.evaluated, 1);
  EXPECT_GT(all.run().totals.peak_force, 0.0);
}

TEST(PairSet, WrenchIsAboutTheOriginOfTheBody) {
  TwoBodies two;
  Pose X_WA = Pose::Identity();
  X_WA.translation() = Vec3(0.4, -0.2, 0.3 - 0.1);  // ball centre at z = 0.5, wall's face at 0.1
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(0.1, 0.2, 0.29);  // face at 0.39, ball's lowest point at 0.4
  two.world.place(two.a, X_WA, {});
  two.world.place(two.b, X_WB, {});
  const PairForces forces = AllPairs(two.world).run();
  const Vec3 f(0.0, 0.0, 25.0);  // half the range: a quarter of the force
  const Vec3 touch(0.4, -0.2, 0.4);
  EXPECT_LE((forces.on_body[two.a.index].force - f).norm(), 1e-9);
  EXPECT_LE((forces.on_body[two.a.index].torque - (touch - X_WA.translation()).cross(f)).norm(),
            1e-9);
  EXPECT_LE((forces.on_body[two.b.index].force + f).norm(), 1e-9);
  EXPECT_LE((forces.on_body[two.b.index].torque + (touch - X_WB.translation()).cross(f)).norm(),
            1e-9);
}

TEST(PairSet, ActionAndReactionCancelAboutACommonPoint) {
  families::Rng random(seed);
  int pushed = 0;
  for (int i = 0; i < 500; ++i) {
    TwoBodies two;
    two.world.place(two.a, test::random_pose(random, 0.3), {{0.1, 0.2, 0.3}, {1, 2, 3}});
    two.world.place(two.b, test::random_pose(random, 0.3), {{-0.1, 0.0, 0.3}, {3, 2, 1}});
    const PairForces forces = AllPairs(two.world).run();
    Wrench sum;
    for (const BodyId id : {two.a, two.b}) {
      const Vec3 p_WB = two.world.motion().bodies[id.index].X_WB.translation();
      sum += moved_to(forces.on_body[id.index], -p_WB);
    }
    EXPECT_LE(sum.force.norm(), 1e-12) << "seed " << seed;
    EXPECT_LE(sum.torque.norm(), 1e-10) << "seed " << seed;
    pushed += forces.totals.peak_force > 0.0 ? 1 : 0;
  }
  EXPECT_GT(pushed, 150) << "seed " << seed;
  EXPECT_LT(pushed, 500) << "seed " << seed;
}

TEST(PairSet, StalePairsNeverClaimMoreDistanceThanThereIs) {
  int compared = 0;
  for (unsigned run = 0; run < 3; ++run) {
    // Everything in range, so that all pairs are near; at rest, so that the force gives the
    // distance.
    test::Boxes boxes(1, 1, {.range = 2.0, .surface_force = 100.0, .damping = 0.0}, seed + run);
    AllPairs all(boxes.world);
    for (int tick = 0; tick < 600; ++tick) {
      boxes.move();
      const bool fresh = tick % 7 == 0;
      const PairForces& forces = all.run(fresh ? no_limit : 0);
      ASSERT_EQ(forces.totals.stale, fresh ? 0 : 1);
      ASSERT_EQ(forces.totals.oldest_age, tick % 7);
      const double felt = forces.on_body[boxes.tool.index].force.norm();
      const Pair& pair = boxes.world.pairs().front();
      const double truth = pair.law(test::separation_now(boxes.world, pair).distance, 0.0);
      ASSERT_GE(felt, truth - 1e-9) << "tick " << tick << ", seed " << seed + run;
      compared += fresh ? 0 : 1;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(PairSet, BudgetIsOverdrawnByOnePairAtMost) {
  test::Boxes boxes(4, 16, {.range = 2.0}, seed);
  AllPairs all(boxes.world);
  all.run();
  std::int64_t dearest = 0;
  for (int tick = 0; tick < 300; ++tick) {
    boxes.move();
    for (const Pair& pair : boxes.world.pairs()) {
      dearest = std::max<std::int64_t>(dearest, test::separation_now(boxes.world, pair).iterations);
    }
    const std::int64_t units = 1 + tick % 60;
    const PairTotals& totals = all.run(units).totals;
    ASSERT_LT(totals.iterations, units + dearest) << "tick " << tick << ", seed " << seed;
    ASSERT_EQ(totals.evaluated + totals.stale, totals.near);
    ASSERT_GE(totals.evaluated, 1);
  }
  EXPECT_GT(dearest, 0);
}

TEST(PairSet, NoPairWaitsLongerThanTheSetHasPairs) {
  // With a budget of one unit one pair is evaluated in each tick, round-robin.
  test::Boxes boxes(4, 16, {.range = 2.0}, seed);
  AllPairs all(boxes.world);
  all.run();
  std::int64_t oldest = 0;
  for (int tick = 0; tick < 400; ++tick) {
    boxes.move();
    oldest = std::max(oldest, all.run(1).totals.oldest_age);
  }
  EXPECT_LE(oldest, all.pairs()) << "seed " << seed;
  EXPECT_GE(oldest, all.pairs() - 1);
}

// An evaluation is never cut short: a partial answer could be wrong by any amount.
TEST(PairSet, AnswersUnderABudgetAreWholeAndNeverPushLessThanTheTruth) {
  for (unsigned run = 0; run < 20; ++run) {
    test::Boxes boxes(1, 1, {.range = 2.0, .surface_force = 100.0, .damping = 0.0}, seed + run);
    AllPairs all(boxes.world);
    all.run();
    for (int tick = 0; tick < 200; ++tick) {
      boxes.move();
      const PairForces& forces = all.run(tick % 3);
      ASSERT_NE(all.set.separation_of({0}).end, QueryEnd::budget_spent);
      const Pair& pair = boxes.world.pairs().front();
      const double truth = pair.law(test::separation_now(boxes.world, pair).distance, 0.0);
      ASSERT_GE(forces.on_body[boxes.tool.index].force.norm(), truth - 1e-9)
          << "tick " << tick << ", seed " << seed + run;
    }
  }
}

TEST(PairSet, DeadlineThatHasPassedLeavesEverythingStale) {
  test::Boxes boxes(4, 8, {.range = 2.0}, seed);
  AllPairs all(boxes.world);
  all.run();
  boxes.move();
  const PairForces& forces = all.run(no_limit, Clock::time_point::min());
  EXPECT_EQ(forces.totals.evaluated, 0);
  EXPECT_EQ(forces.totals.near, 32);
  EXPECT_EQ(forces.totals.stale, 32);
  EXPECT_EQ(forces.totals.oldest_age, 1);
  EXPECT_TRUE(test::is_finite(forces));
}

// Pairs without a slot exert their force as all others do, and are reported.
TEST(PairSet, PairsWithoutASlotAreEvaluatedAllTheSame) {
  test::Boxes boxes(2, 4, {.range = 0.3}, seed);
  detail::PartPoses poses(boxes.world);
  detail::PairSet set(boxes.world, 3);
  int pushed = 0;
  for (int tick = 0; tick < 300; ++tick) {
    boxes.move();
    poses.begin_tick();
    set.begin_tick(tick);
    int taken = 0;
    for (std::int32_t i = 0; i < 8; ++i) {
      taken += set.take({i}, 0, 0.0, boxes.world.motion(), poses) ? 1 : 0;
    }
    set.end(0);
    set.select(boxes.world.motion(), poses, {});
    set.evaluate_all(boxes.world.motion(), poses);
    set.finish(boxes.world.motion(), poses);
    ASSERT_EQ(taken, 3);
    ASSERT_EQ(set.forces().totals.crowded, 5);
    const auto direct = test::forces_now(boxes.world);
    const Vec3 f = set.forces().on_body[boxes.tool.index].force;
    ASSERT_LE((f - direct[boxes.tool.index].force).norm(), 1e-9) << "seed " << seed;
    pushed += f.norm() > 1.0 ? 1 : 0;
  }
  EXPECT_GT(pushed, 100);
}

TEST(PairSet, PairWithoutAnAnswerIsAskedWhateverTheBudget) {
  test::Boxes boxes(1, 4, {.range = 2.0, .damping = 0.0}, seed);
  AllPairs all(boxes.world);
  const PairForces& forces = all.run(0);
  EXPECT_EQ(forces.totals.evaluated, 4);
  const Vec3 direct = test::forces_now(boxes.world)[boxes.tool.index].force;
  EXPECT_LE((forces.on_body[boxes.tool.index].force - direct).norm(), 1e-9);
  EXPECT_EQ(all.run(0).totals.stale, 4);
}

// A pair that leaves the list and returns later continues with its history.
TEST(PairSet, PairOffTheListKeepsItsAnswer) {
  test::Boxes boxes(1, 2, {.range = 0.001}, seed);
  AllPairs all(boxes.world);
  EXPECT_EQ(all.run().totals.evaluated, 2);
  const double before = all.set.separation_of({1}).distance;
  ASSERT_GT(before, 0.01) << "seed " << seed;
  (void)all.set.take({0}, 0, 0.0, boxes.world.motion(), all.poses);
  all.set.end(0);
  EXPECT_EQ(all.run().totals.evaluated, 0);
  EXPECT_EQ(all.set.separation_of({1}).distance, before);
  (void)all.set.take({0}, 0, 0.0, boxes.world.motion(), all.poses);
  (void)all.set.take({1}, 0, 0.0, boxes.world.motion(), all.poses);
  all.set.end(0);
  EXPECT_EQ(all.run().totals.evaluated, 0);
  EXPECT_EQ(all.set.separation_of({1}).distance, before);
}

}  // namespace pair_set_test
}  // namespace repel
