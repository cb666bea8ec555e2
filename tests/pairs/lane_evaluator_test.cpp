// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/lane_evaluator.hpp>

#include <gtest/gtest.h>

#include "pairs/near_pairs.hpp"

namespace repel::detail {
namespace lane_evaluator_test {

constexpr unsigned seed = 1504;

/// Evaluates every pair of a world at each tick; the slot of a pair equals its id.
struct EveryPair {
  EveryPair(const World& the_world, bool in_lanes)
      : world(&the_world),
        use_lanes(in_lanes),
        poses(the_world),
        memory(the_world, static_cast<int>(the_world.pairs().size())),
        forces(the_world.body_count()),
        singles(the_world, memory, forces, 1000),
        lanes(singles, memory, forces) {
    for (std::int32_t i = 0; i < count(); ++i) EXPECT_EQ(memory.slot_for({i}), i);
  }
  [[nodiscard]] int count() const { return static_cast<int>(world->pairs().size()); }
  [[nodiscard]] bool is_in_lane(int slot) { return memory.tracking(slot).lane >= 0; }

  /// @param evaluated false: uses only old answers
  const PairForces& tick(bool evaluated = true) {
    const Motion& motion = world->motion();
    poses.begin_tick();
    singles.begin_tick(motion.tick);
    lanes.begin_tick();
    forces.totals.near = count();
    std::vector<int> others;
    for (int slot = 0; slot < count(); ++slot) {
      if (!is_in_lane(slot)) others.push_back(slot);
    }
    PairTotals& totals = forces.totals;
    for (int g = 0; evaluated && g < lanes.groups(); ++g) {
      lanes.evaluate_group(g, motion, poses, totals);
    }
    for (const int slot : others) {
      if (evaluated) singles.evaluate(slot, motion, poses, totals);
    }
    lanes.push(motion);
    for (const int slot : others) singles.push(slot, motion);
    lanes.remove_ended(poses);
    for (const int slot : others) {
      if (use_lanes && lanes.may_add(slot)) lanes.add(slot, poses);
    }
    return forces;
  }

  const World* world;
  bool use_lanes;
  PartPoses poses;
  PairMemory memory;
  PairForces forces;
  SingleEvaluator singles;
  LaneEvaluator lanes;
};

/// Checks that the first lanes have the pairs, in as few groups as possible, no other lane has one,
/// and that those of two boxes come first.
void expect_no_gaps(EveryPair& every) {
  const LaneEvaluator& lanes = every.lanes;
  ASSERT_EQ(lanes.groups(), (lanes.count() + lane_count - 1) / lane_count);
  for (int g = 0; g < lanes.groups(); ++g) {
    const int taken = std::min(lane_count, lanes.count() - g * lane_count);
    ASSERT_EQ(lanes.group(g).used(), (1U << taken) - 1U) << "group " << g;
  }
  const auto is_box = [&](PartId part) {
    return every.world->part(part).shape.level(0).core.kind() == Convex::Kind::box;
  };
  bool are_boxes = true;
  for (int lane = 0; lane < lanes.count(); ++lane) {
    const int slot = lanes.slot(lane);
    const Pair& pair = every.world->pair({slot});
    const bool are = is_box(pair.a) && is_box(pair.b);
    ASSERT_TRUE(are_boxes || !are) << "lane " << lane;
    are_boxes = are;
    const LaneGroup& group = lanes.group(lane / lane_count);
    ASSERT_EQ(every.memory.tracking(slot).lane, lane);
    ASSERT_EQ(group.body_a(lane % lane_count), every.memory.tracking(slot).body_a);
    ASSERT_EQ(group.body_b(lane % lane_count), every.memory.tracking(slot).body_b);
  }
}

/// Shapes of all kinds near each other, on three moving bodies and the fixed one; every fifth pair
/// is passable.
test::NearPairs of_all_kinds(unsigned run, Measure measure = QueryOptions{}.measure) {
  test::NearPairs scene(3, run, measure);
  for (int i = 0; i < 32; ++i) {
    const Pair pair = scene.world.pair(scene.add(test::random_shape));
    if (i % 4 != 0) continue;
    scene.world.add_pair(pair.a, pair.b, {.range = 0.02, .ceiling = 20.0, .passable = true});
  }
  return scene;
}

TEST(LaneEvaluator, PairsMoveIntoLanesAndOutAgain) {
  int came = 0, left_range = 0, overlapped = 0, full = 0;
  for (unsigned run = 0; run < 20; ++run) {
    test::NearPairs scene = of_all_kinds(seed + run);
    EveryPair with_lanes(scene.world, true);
    std::vector<bool> was(static_cast<std::size_t>(with_lanes.count()));
    for (int tick = 0; tick < 40; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      scene.move(0.003, 0.01);
      const PairTotals& totals = with_lanes.tick().totals;
      ASSERT_EQ(totals.evaluated, with_lanes.count());
      ASSERT_EQ(totals.stale, 0);
      int in_lanes = 0;
      for (int slot = 0; slot < with_lanes.count(); ++slot) {
        const auto i = static_cast<std::size_t>(slot);
        const Pair& pair = scene.world.pair({slot});
        const Separation s = with_lanes.lanes.separation_of(slot);
        const bool is = with_lanes.is_in_lane(slot);
        if (is) {
          ASSERT_FALSE(pair.law.passable);
          ASSERT_LT(s.lower, pair.law.range);
          ASSERT_TRUE(scene.world.part(pair.a).shape.level(0).core.is_polytope());
          ASSERT_TRUE(scene.world.part(pair.b).shape.level(0).core.is_polytope());
        }
        came += is && !was[i] ? 1 : 0;
        left_range += was[i] && !is && s.distance >= pair.law.range ? 1 : 0;
        overlapped += was[i] && !is && s.distance < 0.0 ? 1 : 0;
        was[i] = is;
        in_lanes += is ? 1 : 0;
      }
      ASSERT_EQ(with_lanes.lanes.count(), in_lanes);
      expect_no_gaps(with_lanes);
      full += in_lanes >= 2 * lane_count ? 1 : 0;
    }
  }
  EXPECT_GT(came, 150);
  EXPECT_GT(left_range, 50);
  EXPECT_GT(overlapped, 20);
  EXPECT_GT(full * lane_count, 200);
}

void expect_the_answers_without_lanes(Measure measure) {
  SCOPED_TRACE(to_text(measure));
  int in_lanes = 0;
  int reduced = 0;
  double peak = 0.0;
  for (unsigned run = 0; run < 20; ++run) {
    test::NearPairs scene = of_all_kinds(seed + run, measure);
    EveryPair with_lanes(scene.world, true);
    EveryPair without(scene.world, false);
    for (int tick = 0; tick < 40; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      scene.move(0.003, 0.01);
      const PairForces& a = with_lanes.tick();
      const PairForces& b = without.tick();
      for (int slot = 0; slot < with_lanes.count(); ++slot) {
        const Separation s = with_lanes.lanes.separation_of(slot);
        const Separation t = without.lanes.separation_of(slot);
        ASSERT_NEAR(s.distance, t.distance, 1e-9);
        reduced += s.level > 0 ? 1 : 0;
        const PairExtremes x = with_lanes.lanes.extremes_of({slot});
        const PairExtremes y = without.lanes.extremes_of({slot});
        ASSERT_NEAR(x.nearest, y.nearest, 1e-9);
        ASSERT_NEAR(x.peak_force, y.peak_force, 1e-5);
        ASSERT_NEAR(x.deepest, y.deepest, 1e-9);
        in_lanes += with_lanes.is_in_lane(slot) ? 1 : 0;
      }
      for (std::size_t body = 0; body < a.on_body.size(); ++body) {
        ASSERT_LE((a.on_body[body].force - b.on_body[body].force).norm(), 1e-5);
      }
      ASSERT_NEAR(a.totals.nearest, b.totals.nearest, 1e-9);
      ASSERT_NEAR(a.totals.peak_force, b.totals.peak_force, 1e-5);
      ASSERT_NEAR(a.totals.deepest, b.totals.deepest, 1e-9);
      peak = std::max(peak, a.totals.peak_force);
    }
  }
  EXPECT_GT(in_lanes, 3000);
  EXPECT_GT(peak, 50.0);
  // Of `exact` the shapes with a curved rim are measured by their levels.
  EXPECT_EQ(reduced > 100, measure != Measure::deepest_point) << reduced;
}

TEST(LaneEvaluator, AnswersAreThoseWithoutLanesByEveryMeasure) {
  for (const Measure measure : all_measures) expect_the_answers_without_lanes(measure);
}

/// One tool box and one obstacle at rest, always in range, so that the force gives the distance.
struct OnePair {
  explicit OnePair(unsigned run)
      : boxes(1, 1, {.range = 2.0, .surface_force = 100.0, .damping = 0.0}, run),
        with_lanes(boxes.world, true) {}
  [[nodiscard]] double true_force() const {
    const Pair& pair = boxes.world.pairs().front();
    return pair.law(test::separation_now(boxes.world, pair).distance, 0.0);
  }
  test::Boxes boxes;
  EveryPair with_lanes;
};

TEST(LaneEvaluator, StalePairsPushNoLessThanTheTruthAndThatIsCounted) {
  int stale_in_lanes = 0, counted = 0;
  for (unsigned run = 0; run < 3; ++run) {
    OnePair one(seed + run);
    for (int tick = 0; tick < 700; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      one.boxes.move();
      const bool was_in_lane = one.with_lanes.is_in_lane(0);
      const PairForces& forces = one.with_lanes.tick(tick % 7 < 2);
      const double felt = forces.on_body[one.boxes.tool.index].force.norm();
      ASSERT_GE(felt, one.true_force() - 1e-9);
      ASSERT_EQ(forces.totals.stale, tick % 7 < 2 ? 0 : 1);
      ASSERT_EQ(forces.totals.oldest_age, std::max(0, tick % 7 - 1));
      // Only the first answer after old ones can have refresh energy.
      ASSERT_GE(forces.totals.refresh_energy, 0.0);
      if (tick % 7 != 0 || tick == 0) {
        ASSERT_EQ(forces.totals.refresh_energy, 0.0);
      }
      stale_in_lanes += was_in_lane && tick % 7 >= 2 ? 1 : 0;
      counted += was_in_lane && forces.totals.refresh_energy > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(stale_in_lanes, 800);
  EXPECT_GT(counted, 150);
}

void expect_same(const Separation& a, const Separation& b) {
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.p_WA, b.p_WA);
  EXPECT_EQ(a.p_WB, b.p_WB);
  EXPECT_EQ(a.extraction_W, b.extraction_W);
}

/// Runs a few ticks, the last of them without motion: all pairs in lanes are proven.
void run_a_little(test::NearPairs& scene, EveryPair& with_lanes) {
  for (int tick = 0; tick < 5; ++tick) {
    if (tick < 4) scene.move(0.0005, 0.001);
    with_lanes.tick();
  }
  ASSERT_GE(with_lanes.lanes.count(), 5) << "seed " << seed;
}

struct Known {
  Separation separation;
  PairExtremes extremes;
};
std::vector<Known> known(const EveryPair& with_lanes) {
  std::vector<Known> all;
  for (int slot = 0; slot < with_lanes.count(); ++slot) {
    all.push_back({with_lanes.lanes.separation_of(slot), with_lanes.lanes.extremes_of({slot})});
  }
  return all;
}
void expect_same(const std::vector<Known>& a, const std::vector<Known>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", static_cast<int>(i)));
    expect_same(a[i].separation, b[i].separation);
    EXPECT_EQ(a[i].extremes.nearest, b[i].extremes.nearest);
    EXPECT_EQ(a[i].extremes.peak_force, b[i].extremes.peak_force);
  }
}

TEST(LaneEvaluator, RemovalKeepsWhatIsKnown) {
  test::NearPairs scene = of_all_kinds(seed);
  EveryPair with_lanes(scene.world, true);
  run_a_little(scene, with_lanes);
  const auto before = known(with_lanes);
  for (int slot = 0; slot < with_lanes.count(); slot += 2)
    with_lanes.lanes.remove(slot, with_lanes.poses);
  expect_no_gaps(with_lanes);
  expect_same(known(with_lanes), before);
  with_lanes.lanes.remove_all(with_lanes.poses);
  EXPECT_EQ(with_lanes.lanes.count(), 0);
  for (int slot = 0; slot < with_lanes.count(); ++slot) EXPECT_FALSE(with_lanes.is_in_lane(slot));
  expect_same(known(with_lanes), before);
}

TEST(LaneEvaluator, RehearsingChangesNothing) {
  test::NearPairs scene = of_all_kinds(seed);
  EveryPair with_lanes(scene.world, true);
  run_a_little(scene, with_lanes);
  const auto before = known(with_lanes);
  const PairTotals totals = with_lanes.forces.totals;
  EXPECT_GT(with_lanes.lanes.rehearse(1000, scene.world.motion(), with_lanes.poses), 0);
  expect_same(known(with_lanes), before);
  EXPECT_EQ(with_lanes.forces.totals.evaluated, totals.evaluated);
  EXPECT_EQ(with_lanes.forces.totals.nearest, totals.nearest);
}

/// The slots of the pairs that may go into lanes, after a tick without these.
std::vector<int> fitting_slots(EveryPair& every) {
  every.use_lanes = false;
  (void)every.tick();
  std::vector<int> fitting;
  for (int slot = 0; slot < every.count(); ++slot) {
    if (every.lanes.may_add(slot)) fitting.push_back(slot);
  }
  return fitting;
}

// A group of one pair among many lanes would cost more than the pair alone.
TEST(LaneEvaluator, FewPairsAreEvaluatedSingly) {
  test::NearPairs scene(3, seed);
  for (int i = 0; i < 60; ++i) scene.add(test::random_shape);
  EveryPair every(scene.world, true);
  const std::vector<int> fitting = fitting_slots(every);
  ASSERT_GT(fitting.size(), static_cast<std::size_t>(lane_count) + 1);
  const int few = lane_count < 8 ? lane_count / 2 : 3;
  int added = 0;
  for (int wanted = 0; wanted <= lane_count + 1; ++wanted) {
    const int more = wanted - added;
    const int last = wanted % lane_count;
    EXPECT_EQ(every.lanes.to_add(more), last < few ? more - last : more) << wanted;
    for (int left = every.lanes.to_add(more); left > 0; --left) {
      every.lanes.add(fitting[static_cast<std::size_t>(added++)], every.poses);
    }
  }
  EXPECT_EQ(every.lanes.count(), few > 1 ? lane_count : lane_count + 1);
  // One less than that may stay.
  every.lanes.remove_last(every.lanes.count() - few + 1, every.poses);
  EXPECT_EQ(every.lanes.count(), few - 1);
  EXPECT_EQ(every.lanes.to_add(0), 0);
  if (few < 3) return;
  every.lanes.remove_last(1, every.poses);
  EXPECT_EQ(every.lanes.to_add(0), -1);
}

// Lanes take memory, so that there are fewer than pairs where these are many.
TEST(LaneEvaluator, PairsWithoutALaneAreEvaluatedSingly) {
  test::NearPairs scene(3, seed);
  for (int i = 0; i < 1600; ++i)
    scene.add([](families::Rng&) { return Shape::box({0.1, 0.1, 0.1}); });
  EveryPair every(scene.world, true);
  const std::vector<int> fitting = fitting_slots(every);
  const int all = static_cast<int>(fitting.size());
  const int more = every.lanes.to_add(all);
  EXPECT_EQ(more, 256);
  ASSERT_GT(all, more) << "of " << every.count();
  for (int i = 0; i < more; ++i) every.lanes.add(fitting[static_cast<std::size_t>(i)], every.poses);
  EXPECT_EQ(every.lanes.to_add(all - more), 0);
  scene.move(0.0, 0.0);
  const PairTotals& totals = every.tick().totals;
  EXPECT_EQ(totals.evaluated, every.count());
  EXPECT_EQ(totals.stale, 0);
}

}  // namespace lane_evaluator_test
}  // namespace repel::detail
