// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/single_evaluator.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace single_evaluator_test {

constexpr unsigned seed = 919;
constexpr std::int64_t max_age = 10;

/// An evaluator with a slot for each pair: the slot of a pair equals its id.
struct Evaluator {
  explicit Evaluator(const World& the_world)
      : world(&the_world),
        poses(the_world),
        memory(the_world, static_cast<int>(the_world.pairs().size())),
        forces(the_world.body_count()),
        pairs(the_world, memory, forces, max_age) {
    for (std::int32_t i = 0; i < count(); ++i) EXPECT_EQ(memory.slot_for({i}), i);
  }
  [[nodiscard]] int count() const { return memory.slots(); }
  [[nodiscard]] const Motion& motion() const { return world->motion(); }
  void begin_tick() {
    poses.begin_tick();
    pairs.begin_tick(motion().tick);
  }
  void evaluate(int slot) { pairs.evaluate(slot, motion(), poses, forces.totals); }
  /// One tick in which the pair of a slot is evaluated, or not.
  const PairForces& tick(int slot, bool evaluated) {
    begin_tick();
    if (evaluated) evaluate(slot);
    ++forces.totals.near;
    pairs.push(slot, motion());
    return forces;
  }

  const World* world;
  PartPoses poses;
  PairMemory memory;
  PairForces forces;
  SingleEvaluator pairs;
};

/// Balls of 0.1 m at various heights above the top of a table, z = 0.
struct Balls {
  World world;
  std::vector<BodyId> bodies;

  explicit Balls(const std::vector<double>& gaps) {
    Pose X_WT = Pose::Identity();
    X_WT.translation().z() = -0.5;
    const PartId table = world.add_part(World::fixed, "table", Shape::box({5.0, 5.0, 0.5}), X_WT);
    for (const double gap : gaps) {
      bodies.push_back(world.add_body("ball"));
      const PartId ball = world.add_part(bodies.back(), "ball", Shape::sphere(0.1));
      world.add_pair(ball, table, {.range = 0.02, .surface_force = 100.0, .damping = 0.0});
      place(bodies.size() - 1, gap, 0.0);
    }
    world.motion().tick = 0;
  }
  void place(std::size_t ball, double gap, double speed, double angle = 0.0) {
    Pose X = Pose::Identity();
    X.translation() = Vec3(0.3 * static_cast<double>(ball), 0.0, 0.1 + gap);
    X.linear() = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
    world.place(bodies[ball], X, {{0.0, 0.0, speed}, Vec3::Zero()});
  }
  [[nodiscard]] const ForceLaw& law() const { return world.pair({0}).law; }
};

// How often a pair is evaluated out of range has no effect on its forces.
TEST(SingleEvaluator, BeginsColdWhenAPairComesWithinRange) {
  int skipped = 0, pushed = 0, entered = 0;
  for (unsigned run = 0; run < 3; ++run) {
    test::Boxes boxes(4, 40, {.range = 0.03}, seed + run);
    Evaluator always(boxes.world);
    Evaluator seldom(boxes.world);
    for (int tick = 0; tick < 600; ++tick) {
      boxes.move();
      always.begin_tick();
      seldom.begin_tick();
      for (int slot = 0; slot < always.count(); ++slot) {
        always.evaluate(slot);
        always.pairs.push(slot, always.motion());
        const bool was_inside = seldom.memory.answer(slot).in_range;
        const bool far = always.memory.answer(slot).last.lower > 0.031;
        skipped += far && !was_inside ? 1 : 0;
        if (far && !was_inside) continue;
        seldom.evaluate(slot);
        seldom.pairs.push(slot, seldom.motion());
        entered += !was_inside && seldom.memory.answer(slot).in_range ? 1 : 0;
      }
      always.forces.totals.near = seldom.forces.totals.near = 1;
      for (std::size_t body = 0; body < 2; ++body) {
        const Wrench& all = always.forces.on_body[body];
        const Wrench& some = seldom.forces.on_body[body];
        ASSERT_EQ(all.force, some.force) << "tick " << tick << ", seed " << seed + run;
        ASSERT_EQ(all.torque, some.torque) << "tick " << tick << ", seed " << seed + run;
      }
      pushed += seldom.forces.totals.peak_force > 1.0 ? 1 : 0;
    }
  }
  EXPECT_GT(skipped, 3 * 600 * 160 / 2);
  EXPECT_GT(pushed, 300);
  EXPECT_GT(entered, 50);
}

// Also those of passable bodies, whose slope takes a second query.
TEST(SingleEvaluator, EveryMeasureOfAWorldDecidesItsOverlaps) {
  for (const Measure measure : all_measures) {
    test::Boxes boxes(4, 200, {.range = 0.02, .ceiling = 20.0, .passable = true}, seed, measure);
    Evaluator evaluator(boxes.world);
    int overlaps = 0;
    int others = 0;
    for (int tick = 0; tick < 200; ++tick) {
      boxes.move();
      evaluator.begin_tick();
      for (int slot = 0; slot < evaluator.count(); ++slot) {
        const Pair& pair = boxes.world.pair({slot});
        evaluator.evaluate(slot);
        const PairAnswer& answer = evaluator.memory.answer(slot);
        ASSERT_NEAR(answer.last.distance, test::separation_now(boxes.world, pair).distance, 1e-9);
        ASSERT_GE(answer.last.distance, -boxes.world.deepest(pair) - 1e-12) << to_text(measure);
        if (answer.last.distance > -1e-3) continue;
        ++overlaps;
        const Pose X_WA = test::pose_of(boxes.world, pair.a);
        const Separation by_default =
            separation(boxes.world.part(pair.a).shape, X_WA, boxes.world.part(pair.b).shape,
                       test::pose_of(boxes.world, pair.b));
        others += std::abs(answer.last.distance - by_default.distance) > 1e-4 ? 1 : 0;
        WarmStart warm = evaluator.memory.history(slot).warm;
        int iterations = 0;
        const PosedShape A{boxes.world.part(pair.a).shape, X_WA};
        const Pose X_WB = test::pose_of(boxes.world, pair.b);
        const PosedShape B{boxes.world.part(pair.b).shape, X_WB};
        ASSERT_NEAR(answer.slope,
                    slope_of(answer.last, A, B, boxes.world.query_options(), warm, iterations),
                    1e-6);
      }
    }
    EXPECT_GT(overlaps, 100);
    EXPECT_EQ(others > 20, measure != QueryOptions{}.measure) << others << to_text(measure);
  }
}

TEST(SingleEvaluator, ForceOfAnOldAnswerFadesAndIsGoneAtTwiceTheAge) {
  Balls balls({0.01});
  Evaluator evaluator(balls.world);
  const auto body = static_cast<std::size_t>(balls.bodies[0].index);
  EXPECT_NEAR(evaluator.tick(0, true).on_body[body].force.z(), 25.0, 1e-9);
  for (int age = 1; age <= 30; ++age) {
    balls.world.motion().tick = age;
    const PairForces& forces = evaluator.tick(0, false);
    EXPECT_EQ(forces.totals.stale, 1);
    EXPECT_EQ(forces.totals.oldest_age, age);
    EXPECT_EQ(forces.totals.expired, age > max_age ? 1 : 0);
    const double share = age <= max_age ? 1.0 : 2.0 - static_cast<double>(age) / max_age;
    EXPECT_NEAR(forces.on_body[body].force.z(), 25.0 * std::max(0.0, share), 1e-9) << age;
    if (age >= 2 * max_age) {
      EXPECT_EQ(forces.on_body[body].force, Vec3::Zero()) << age;
    }
  }
  const PairForces& again = evaluator.tick(0, true);
  EXPECT_EQ(again.totals.stale, 0);
  EXPECT_NEAR(again.on_body[body].force.z(), 25.0, 1e-9);
}

// A ball that rotates in place comes no nearer, but the bound by its old answer decreases.
TEST(SingleEvaluator, CountsTheEnergyByWhichAStaleBoundWasWrong) {
  Balls balls({0.01});
  Evaluator evaluator(balls.world);
  EXPECT_EQ(evaluator.tick(0, true).totals.refresh_energy, 0.0);
  const double turn = balls.world.motion().bodies[balls.bodies[0].index].turn;
  balls.place(0, 0.01, 0.0, 0.05);
  EXPECT_EQ(evaluator.tick(0, false).totals.refresh_energy, 0.0);
  const double assumed = 0.01 - (balls.world.motion().bodies[balls.bodies[0].index].turn - turn);
  EXPECT_LT(assumed, 0.006);
  EXPECT_NEAR(evaluator.tick(0, true).totals.refresh_energy,
              balls.law().potential(assumed) - balls.law().potential(0.01), 1e-12);
  balls.place(0, 0.01, 0.0, 0.1);
  EXPECT_EQ(evaluator.tick(0, true).totals.refresh_energy, 0.0);
}

TEST(SingleEvaluator, MostUrgentIsWhatTouchesFirst) {
  Balls balls({0.01, 0.01, 0.005, -0.01, 0.001});
  const std::vector<double> speed{-0.1, -0.5, -0.1, 0.0, 0.3};
  Evaluator evaluator(balls.world);
  for (std::size_t i = 0; i < speed.size(); ++i) {
    balls.place(i, balls.world.motion().bodies[balls.bodies[i].index].X_WB.translation().z() - 0.1,
                speed[i]);
  }
  evaluator.begin_tick();
  std::vector<double> time;
  for (int slot = 0; slot < evaluator.count(); ++slot) {
    evaluator.evaluate(slot);
    time.push_back(evaluator.pairs.time_to_touch(slot, evaluator.motion()));
  }
  EXPECT_NEAR(time[0], 0.1, 1e-9);
  EXPECT_NEAR(time[1], 0.02, 1e-9);
  EXPECT_NEAR(time[2], 0.05, 1e-9);
  EXPECT_LT(time[3], 0.0);  // in overlap
  EXPECT_GT(time[4], 1e6);  // separating
}

TEST(SingleEvaluator, IsDueWhenTheClearanceHasBeenTravelled) {
  Balls balls({0.1});
  Evaluator evaluator(balls.world);
  EXPECT_TRUE(evaluator.pairs.is_due(0, evaluator.motion()));  // it has never been evaluated
  (void)evaluator.tick(0, true);
  EXPECT_TRUE(evaluator.pairs.is_fresh(0));
  balls.place(0, 0.021, 0.0);
  EXPECT_FALSE(evaluator.pairs.is_due(0, evaluator.motion()));
  balls.place(0, 0.019, 0.0);
  EXPECT_TRUE(evaluator.pairs.is_due(0, evaluator.motion()));
  // A smaller clearance does not override a larger one set earlier.
  evaluator.pairs.set_clearance(0, evaluator.motion(), 0.05);
  evaluator.pairs.set_clearance(0, evaluator.motion(), 0.01);
  balls.place(0, 0.06, 0.0);
  EXPECT_FALSE(evaluator.pairs.is_due(0, evaluator.motion()));
  evaluator.begin_tick();
  EXPECT_FALSE(evaluator.pairs.is_fresh(0));
}

}  // namespace single_evaluator_test
}  // namespace repel::detail
