#include <repel/schedule/coprocessor.hpp>

#include <gtest/gtest.h>

#include <cstring>

#include "schedule/boxes.hpp"

namespace repel {
namespace {

using namespace std::chrono_literals;
constexpr unsigned seed = 560;

CoprocessorOptions lock_step(int threads, const Budget& budget = {}) {
  CoprocessorOptions options;
  options.threads = threads;
  options.budget = budget;
  options.lock_step = true;
  return options;
}

bool same_bits(const Vec3& a, const Vec3& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;
}

void expect_same_bits(const PairForces& a, const PairForces& b, const std::string& where) {
  SCOPED_TRACE(where);
  ASSERT_EQ(a.on_body.size(), b.on_body.size());
  for (std::size_t i = 0; i < a.on_body.size(); ++i) {
    ASSERT_TRUE(same_bits(a.on_body[i].force, b.on_body[i].force));
    ASSERT_TRUE(same_bits(a.on_body[i].torque, b.on_body[i].torque));
  }
  ASSERT_EQ(a.tick, b.tick);
  ASSERT_EQ(a.totals.near, b.totals.near);
  ASSERT_EQ(a.totals.evaluated, b.totals.evaluated);
  ASSERT_EQ(a.totals.stale, b.totals.stale);
  ASSERT_EQ(a.totals.oldest_age, b.totals.oldest_age);
  ASSERT_EQ(a.totals.iterations, b.totals.iterations);
  ASSERT_EQ(a.totals.nearest, b.totals.nearest);
  ASSERT_EQ(a.totals.nearest_pair, b.totals.nearest_pair);
  ASSERT_EQ(a.totals.peak_force, b.totals.peak_force);
}

/// The forces of every tick of one motion of 4 x 80 boxes.
std::vector<PairForces> replay(int threads, const Budget& budget) {
  test::Boxes boxes(4, 80, {.range = 0.05}, seed);
  Coprocessor coprocessor(boxes.world, lock_step(threads, budget));
  std::vector<PairForces> run;
  for (int tick = 0; tick < 120; ++tick) {
    boxes.move();
    run.push_back(coprocessor.exchange());
    EXPECT_FALSE(coprocessor.late());
  }
  return run;
}

TEST(Coprocessor, AnyNumberOfThreadsGivesTheSameBits) {
  for (const std::int64_t units : {0, 60}) {
    const auto alone = replay(0, {.work_units = units});
    std::int64_t stale = 0;
    double peak = 0.0;
    for (const PairForces& forces : alone) {
      stale += forces.totals.stale;
      peak = std::max(peak, forces.totals.peak_force);
    }
    EXPECT_EQ(stale > 0, units > 0) << "the budget is meant to bind, seed " << seed;
    EXPECT_GT(peak, 0.0);
    for (const int threads : {1, 2, 3}) {
      const auto shared = replay(threads, {.work_units = units});
      for (std::size_t tick = 0; tick < alone.size(); ++tick) {
        expect_same_bits(alone[tick], shared[tick],
                         std::to_string(threads) + " threads, tick " + std::to_string(tick) +
                             ", seed " + std::to_string(seed));
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

TEST(Coprocessor, ForcesAreThoseOfADirectEvaluation) {
  for (const int threads : {0, 2}) {
    test::Boxes boxes(4, 8, {.range = 0.05}, seed);
    Coprocessor coprocessor(boxes.world, lock_step(threads));
    for (int tick = 0; tick < 100; ++tick) {
      boxes.move();
      const PairForces& forces = coprocessor.exchange();
      const auto direct = test::forces_now(boxes.world);
      for (std::size_t body = 0; body < direct.size(); ++body) {
        ASSERT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-9);
        ASSERT_LE((forces.on_body[body].torque - direct[body].torque).norm(), 1e-9);
      }
    }
  }
}

/// How many pairs were evaluated in 250 ticks whose forces are compared with those of all pairs.
std::int64_t expect_forces_of_all_pairs(int threads, const Limits& limits, bool crowded) {
  test::Crowd crowd(seed, limits);
  Coprocessor coprocessor(crowd.world, lock_step(threads));
  std::int64_t evaluated = 0;
  for (int tick = 0; tick < 250; ++tick) {
    SCOPED_TRACE(families::of_seed(seed, "tick", tick));
    crowd.move();
    const PairForces& forces = coprocessor.exchange();
    const auto direct = test::forces_now(crowd.world);
    for (std::size_t body = 0; body < direct.size(); ++body) {
      EXPECT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-9);
      EXPECT_LE((forces.on_body[body].torque - direct[body].torque).norm(), 1e-9);
    }
    int in_range = 0;
    for (const Pair& pair : crowd.world.pairs()) {
      in_range += test::separation_now(crowd.world, pair).distance < pair.law.range ? 1 : 0;
    }
    EXPECT_GE(forces.totals.near, in_range);
    EXPECT_EQ(forces.totals.stale, 0);
    EXPECT_EQ(forces.totals.crowded > 0, crowded);
    evaluated += forces.totals.evaluated;
    if (testing::Test::HasFailure()) break;
  }
  return evaluated;
}

// Several bodies that move, one against the other and against what is fixed.
TEST(Coprocessor, SkippingPairsChangesNoForce) {
  const test::Crowd crowd(seed);
  const auto all = static_cast<std::int64_t>(250 * crowd.world.pairs().size());
  for (const int threads : {0, 1, 2}) {
    EXPECT_LT(expect_forces_of_all_pairs(threads, {}, false), all / 3) << threads << " threads";
  }
}

TEST(Coprocessor, ForcesAreThoseOfAllPairsWhenMemoryIsShort) {
  for (const int candidates : {0, 4, 20}) {
    for (const int threads : {0, 2}) {
      (void)expect_forces_of_all_pairs(threads, {.candidates = candidates}, true);
    }
  }
}

TEST(Coprocessor, AnswersForEveryPairByItsId) {
  for (const int threads : {0, 3}) {
    test::Boxes boxes(4, 50, {.range = 2.0}, seed);
    Coprocessor coprocessor(boxes.world, lock_step(threads));
    boxes.move();
    (void)coprocessor.exchange();
    for (std::int32_t i = 0; i < 200; ++i) {
      const double truth = test::separation_now(boxes.world, boxes.world.pair({i})).distance;
      ASSERT_NEAR(coprocessor.separation_of({i}).distance, truth, 1e-12) << "pair " << i;
    }
  }
}

TEST(Coprocessor, RefusesMoreThreadsThanTheLimit) {
  World world(Limits{.threads = 2});
  CoprocessorOptions options;
  for (const int threads : {-1, 3}) {
    options.threads = threads;
    EXPECT_THROW(Coprocessor(world, options), SetupError) << threads;
  }
}

TEST(Coprocessor, WorldWithoutPairsGivesNoForce) {
  for (const int threads : {0, 2}) {
    World world;
    world.add_body("tool");
    Coprocessor coprocessor(world, lock_step(threads, {.work_units = 10}));
    world.motion().tick = 0;
    const PairForces& forces = coprocessor.exchange();
    EXPECT_FALSE(coprocessor.late());
    ASSERT_EQ(forces.on_body.size(), 2U);
    EXPECT_EQ(forces.on_body[1].force, Vec3::Zero());
    EXPECT_EQ(forces.totals.near, 0);
  }
}

std::atomic<unsigned> started{0};

TEST(Coprocessor, CallsTheStartFunctionInEachWorker) {
  started = 0;
  World world;
  CoprocessorOptions options = lock_step(3);
  options.on_thread_start = [](int index) noexcept { started |= 1U << index; };
  Coprocessor coprocessor(world, options);
  const auto until = std::chrono::steady_clock::now() + 10s;
  while (started != 7U && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(started, 7U);
}

TEST(Coprocessor, LateAnswerLeavesTheOlderForcesAndIsSaid) {
  test::Boxes boxes(4, 2000, {.range = 2.0}, seed);
  CoprocessorOptions options;
  options.threads = 1;
  options.period = 1ms;
  options.patience = 0ns;
  Coprocessor coprocessor(boxes.world, options);
  Coprocessor here(boxes.world, lock_step(0));
  PairForces before = here.exchange();

  // No patience: eight thousand pairs are not done between two statements, unless this thread is
  // held up just there; then once more.
  bool late = false;
  for (int i = 0; i < 100 && !late; ++i) {
    boxes.move();
    const PairForces got = coprocessor.exchange();
    late = coprocessor.late();
    const PairForces now = here.exchange();
    if (late) {
      EXPECT_EQ(got.tick, boxes.world.motion().tick);
      EXPECT_EQ(got.totals.stale, got.totals.near);
      EXPECT_GE(got.totals.oldest_age, 1);
      // The two came to it on different ways, warm and cold: the same force, not the same bits.
      const Vec3 older = before.on_body[boxes.tool.index].force;
      const Vec3 force = got.on_body[boxes.tool.index].force;
      EXPECT_LE((force - older).norm(), 1e-9 * (1.0 + older.norm()));
    }
    before = now;
  }
  EXPECT_TRUE(late);

  // The same motion offered until its answer is there.
  for (int i = 0; i < 5000 && late; ++i) {
    std::this_thread::sleep_for(2ms);
    (void)coprocessor.exchange();
    late = coprocessor.late();
  }
  EXPECT_FALSE(late);
  const PairForces& after = coprocessor.exchange();
  EXPECT_EQ(after.totals.stale, 0);
  EXPECT_LE((after.on_body[boxes.tool.index].force - before.on_body[boxes.tool.index].force).norm(),
            1e-9 * (1.0 + before.on_body[boxes.tool.index].force.norm()));
}

// Two bodies that move as one keep their distance, however far they leap. A worker that saw one of
// them at another tick would report another distance.
TEST(Coprocessor, WorkersNeverSeeAMixOfTwoTicks) {
  World world;
  const BodyId a = world.add_body("a");
  const BodyId b = world.add_body("b");
  Pose X_BP = Pose::Identity();
  X_BP.translation().x() = 0.21;
  const PartId ball_a = world.add_part(a, "a", Shape::sphere(0.1));
  const PartId ball_b = world.add_part(b, "b", Shape::sphere(0.1), X_BP);
  for (int i = 0; i < 192; ++i) world.add_pair(ball_a, ball_b, {.range = 0.02});
  CoprocessorOptions options;
  options.threads = 2;
  options.period = 100us;
  options.patience = 20us;
  Coprocessor coprocessor(world, options);
  families::Rng random(seed);
  int answered = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    Pose X = Pose::Identity();
    X.translation() = families::uniform(random, 0.0, 5.0) * families::direction(random);
    world.motion().tick = tick;
    ASSERT_TRUE(world.place(a, X, {}) && world.place(b, X, {}));
    const PairForces& forces = coprocessor.exchange();
    ASSERT_NEAR(forces.totals.nearest, 0.01, 1e-9) << "tick " << tick << ", seed " << seed;
    ASSERT_NEAR(forces.totals.peak_force, 25.0, 1e-6) << "tick " << tick << ", seed " << seed;
    answered += coprocessor.late() ? 0 : 1;
  }
  EXPECT_GT(answered, 0);
}

}  // namespace
}  // namespace repel
