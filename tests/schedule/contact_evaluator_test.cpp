#include <repel/schedule/contact_evaluator.hpp>

#include <gtest/gtest.h>

#include "schedule/near_pairs.hpp"

namespace repel::detail {
namespace contact_evaluator_test {

constexpr unsigned seed = 1504;

/// Every pair of a world, worked through at each tick; the slot of a pair has its number.
struct EveryPair {
  EveryPair(const World& the_world, bool the_seating)
      : world(&the_world),
        seating(the_seating),
        poses(the_world),
        contacts(the_world, {}, static_cast<int>(the_world.pairs().size()), 1000) {
    for (std::int32_t i = 0; i < count(); ++i) EXPECT_EQ(memory().slot_for({i}), i);
  }
  [[nodiscard]] int count() const { return static_cast<int>(world->pairs().size()); }
  [[nodiscard]] PairMemory& memory() { return contacts.pairs().memory(); }
  [[nodiscard]] bool is_seated(int slot) { return memory().watch(slot).seat >= 0; }

  /// @param asked false: only old answers are used
  const PairForces& tick(bool asked = true) {
    const Motion& motion = world->motion();
    poses.begin();
    contacts.begin(motion.tick);
    contacts.pairs().forces().totals.near = count();
    std::vector<int> singles;
    for (int slot = 0; slot < count(); ++slot) {
      if (!is_seated(slot)) singles.push_back(slot);
    }
    for (int g = 0; asked && g < contacts.groups(); ++g) {
      contacts.evaluate_group(g, motion, poses);
    }
    for (const int slot : singles) {
      if (asked) contacts.pairs().evaluate(slot, motion, poses);
    }
    contacts.push_contacts(motion);
    for (const int slot : singles) contacts.pairs().push(slot, motion);
    contacts.dismiss(poses);
    for (const int slot : singles) {
      if (seating) contacts.seat(slot, poses);
    }
    return contacts.pairs().forces();
  }

  const World* world;
  bool seating;
  PartPoses poses;
  ContactEvaluator contacts;
};

/// Shapes of all kinds near each other, on three bodies that move and the fixed one; every fifth
/// pair is passable.
test::NearPairs of_all_kinds(unsigned run) {
  test::NearPairs scene(3, run);
  for (int i = 0; i < 32; ++i) {
    const Pair pair = scene.world.pair(scene.add(test::random_shape));
    if (i % 4 != 0) continue;
    scene.world.add_pair(pair.a, pair.b, {.range = 0.02, .ceiling = 20.0, .passable = true});
  }
  return scene;
}

TEST(ContactEvaluator, PairsMoveIntoLanesAndOutAgain) {
  int came = 0, left_range = 0, overlapped = 0, full = 0;
  for (unsigned run = 0; run < 20; ++run) {
    test::NearPairs scene = of_all_kinds(seed + run);
    EveryPair lanes(scene.world, true);
    std::vector<bool> was(static_cast<std::size_t>(lanes.count()));
    for (int tick = 0; tick < 40; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      scene.move(0.003, 0.01);
      const PairTotals& totals = lanes.tick().totals;
      ASSERT_EQ(totals.evaluated, lanes.count());
      ASSERT_EQ(totals.stale, 0);
      int seated = 0;
      for (int slot = 0; slot < lanes.count(); ++slot) {
        const auto i = static_cast<std::size_t>(slot);
        const Pair& pair = scene.world.pair({slot});
        const Separation s = lanes.contacts.separation_of(slot);
        const bool is = lanes.is_seated(slot);
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
        seated += is ? 1 : 0;
      }
      ASSERT_EQ(lanes.contacts.count(), seated);
      full += seated >= 2 * lane_count ? 1 : 0;
    }
  }
  EXPECT_GT(came, 150);
  EXPECT_GT(left_range, 50);
  EXPECT_GT(overlapped, 20);
  EXPECT_GT(full, 100);
}

TEST(ContactEvaluator, AnswersAreThoseWithoutLanes) {
  int in_lanes = 0;
  double peak = 0.0;
  for (unsigned run = 0; run < 20; ++run) {
    test::NearPairs scene = of_all_kinds(seed + run);
    EveryPair lanes(scene.world, true);
    EveryPair singles(scene.world, false);
    for (int tick = 0; tick < 40; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      scene.move(0.003, 0.01);
      const PairForces& a = lanes.tick();
      const PairForces& b = singles.tick();
      for (int slot = 0; slot < lanes.count(); ++slot) {
        const Separation s = lanes.contacts.separation_of(slot);
        const Separation t = singles.contacts.separation_of(slot);
        ASSERT_NEAR(s.distance, t.distance, 1e-9);
        const PairExtremes x = lanes.contacts.extremes_of({slot});
        const PairExtremes y = singles.contacts.extremes_of({slot});
        ASSERT_NEAR(x.nearest, y.nearest, 1e-9);
        ASSERT_NEAR(x.peak_force, y.peak_force, 1e-5);
        in_lanes += lanes.is_seated(slot) ? 1 : 0;
      }
      for (std::size_t body = 0; body < a.on_body.size(); ++body) {
        ASSERT_LE((a.on_body[body].force - b.on_body[body].force).norm(), 1e-5);
      }
      ASSERT_NEAR(a.totals.nearest, b.totals.nearest, 1e-9);
      ASSERT_NEAR(a.totals.peak_force, b.totals.peak_force, 1e-5);
      peak = std::max(peak, a.totals.peak_force);
    }
  }
  EXPECT_GT(in_lanes, 3000);
  EXPECT_GT(peak, 50.0);
}

/// One tool box and one obstacle at rest, in reach wherever they are: force shows distance.
struct OnePair {
  explicit OnePair(unsigned run)
      : boxes(1, 1, {.range = 2.0, .surface_force = 100.0, .damping = 0.0}, run),
        lanes(boxes.world, true) {}
  [[nodiscard]] double true_force() const {
    const Pair& pair = boxes.world.pairs().front();
    return pair.law(test::separation_now(boxes.world, pair).distance, 0.0);
  }
  test::Boxes boxes;
  EveryPair lanes;
};

TEST(ContactEvaluator, StaleContactsPushNoLessThanTheTruthAndThatIsCounted) {
  int stale_contacts = 0, counted = 0;
  for (unsigned run = 0; run < 3; ++run) {
    OnePair one(seed + run);
    for (int tick = 0; tick < 700; ++tick) {
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      one.boxes.move();
      const bool was_seated = one.lanes.is_seated(0);
      const PairForces& forces = one.lanes.tick(tick % 7 < 2);
      const double felt = forces.on_body[one.boxes.tool.index].force.norm();
      ASSERT_GE(felt, one.true_force() - 1e-9);
      ASSERT_EQ(forces.totals.stale, tick % 7 < 2 ? 0 : 1);
      ASSERT_EQ(forces.totals.oldest_age, std::max(0, tick % 7 - 1));
      // Only the first answer after old ones can give anything back.
      ASSERT_GE(forces.totals.refresh_energy, 0.0);
      if (tick % 7 != 0 || tick == 0) {
        ASSERT_EQ(forces.totals.refresh_energy, 0.0);
      }
      stale_contacts += was_seated && tick % 7 >= 2 ? 1 : 0;
      counted += was_seated && forces.totals.refresh_energy > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(stale_contacts, 800);
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

/// A few ticks, at the last of which nothing moves: all contacts are proven.
void run_a_little(test::NearPairs& scene, EveryPair& lanes) {
  for (int tick = 0; tick < 5; ++tick) {
    if (tick < 4) scene.move(0.0005, 0.001);
    lanes.tick();
  }
  ASSERT_GE(lanes.contacts.count(), 5) << "seed " << seed;
}

struct Known {
  Separation separation;
  PairExtremes extremes;
};
std::vector<Known> known(const EveryPair& lanes) {
  std::vector<Known> all;
  for (int slot = 0; slot < lanes.count(); ++slot) {
    all.push_back({lanes.contacts.separation_of(slot), lanes.contacts.extremes_of({slot})});
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

TEST(ContactEvaluator, UnseatingKeepsWhatIsKnown) {
  test::NearPairs scene = of_all_kinds(seed);
  EveryPair lanes(scene.world, true);
  run_a_little(scene, lanes);
  const auto before = known(lanes);
  for (int slot = 0; slot < lanes.count(); slot += 2) lanes.contacts.unseat(slot, lanes.poses);
  expect_same(known(lanes), before);
  lanes.contacts.unseat_all(lanes.poses);
  EXPECT_EQ(lanes.contacts.count(), 0);
  for (int slot = 0; slot < lanes.count(); ++slot) EXPECT_FALSE(lanes.is_seated(slot));
  expect_same(known(lanes), before);
}

TEST(ContactEvaluator, RehearsingChangesNothing) {
  test::NearPairs scene = of_all_kinds(seed);
  EveryPair lanes(scene.world, true);
  run_a_little(scene, lanes);
  const auto before = known(lanes);
  const PairTotals totals = lanes.contacts.pairs().forces().totals;
  EXPECT_GT(lanes.contacts.rehearse(1000, scene.world.motion(), lanes.poses), 0);
  expect_same(known(lanes), before);
  EXPECT_EQ(lanes.contacts.pairs().forces().totals.evaluated, totals.evaluated);
  EXPECT_EQ(lanes.contacts.pairs().forces().totals.nearest, totals.nearest);
}

}  // namespace contact_evaluator_test
}  // namespace repel::detail
