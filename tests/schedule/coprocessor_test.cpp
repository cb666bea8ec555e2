// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/coprocessor.hpp>

#include <gtest/gtest.h>

#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <thread>
#include <utility>

#include "pairs/boxes.hpp"
#include "support/comes_true.hpp"

namespace repel {
namespace coprocessor_test {

using namespace std::chrono_literals;
using test::comes_true;
constexpr unsigned seed = 560;

CoprocessorOptions lock_step(int threads, const Budget& budget = {}) {
  CoprocessorOptions options;
  options.threads = threads;
  options.budget = budget;
  options.lock_step = true;
  return options;
}

CoprocessorOptions beside(int threads) {
  CoprocessorOptions options = lock_step(threads);
  options.mode = CoprocessorMode::beside;
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
  ASSERT_EQ(a.totals.hardest_pair, b.totals.hardest_pair);
}

/// The forces of every tick of one motion of 4 x 160 boxes.
std::vector<PairForces> replay(const CoprocessorOptions& options) {
  test::Boxes boxes(4, 160, {.range = 0.15}, seed);
  Coprocessor coprocessor(boxes.world, options);
  EXPECT_EQ(coprocessor.threads(), options.threads);
  std::vector<PairForces> run;
  for (int tick = 0; tick < 120; ++tick) {
    boxes.move();
    run.push_back(coprocessor.exchange());
    EXPECT_FALSE(coprocessor.late());
  }
  const bool counted = options.budget.work_units > 0;
  EXPECT_EQ(coprocessor.workers().shared > 0, options.threads > 0 && !counted);
  return run;
}

void expect_same_bits(const std::vector<PairForces>& a, const std::vector<PairForces>& b,
                      int threads) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    expect_same_bits(a[tick], b[tick],
                     std::to_string(threads) + " threads, tick " + std::to_string(tick) +
                         ", seed " + std::to_string(seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Coprocessor, AnyNumberOfThreadsGivesTheSameBits) {
  for (const std::int64_t units : {0, 60}) {
    const auto alone = replay(lock_step(0, {.work_units = units}));
    std::int64_t stale = 0;
    double peak = 0.0;
    for (const PairForces& forces : alone) {
      stale += forces.totals.stale;
      peak = std::max(peak, forces.totals.peak_force);
    }
    EXPECT_EQ(stale > 0, units > 0) << "the budget is meant to bind, seed " << seed;
    EXPECT_GT(peak, 0.0);
    for (const int threads : {1, 2, 3}) {
      expect_same_bits(alone, replay(lock_step(threads, {.work_units = units})), threads);
    }
  }
}

TEST(Coprocessor, ForcesAreThoseOfADirectEvaluation) {
  for (const Measure measure : all_measures) {
    for (const int threads : {0, 2}) {
      test::Boxes boxes(4, 60, {.range = 0.05}, seed, measure);
      Coprocessor coprocessor(boxes.world, lock_step(threads));
      double deepest = 0.0;
      for (int tick = 0; tick < 100; ++tick) {
        boxes.move();
        const PairForces& forces = coprocessor.exchange();
        const auto direct = test::forces_now(boxes.world);
        // A patch turns with the normals divided by its tilt.
        for (std::size_t body = 0; body < direct.size(); ++body) {
          ASSERT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-6)
              << to_text(measure);
          ASSERT_LE((forces.on_body[body].torque - direct[body].torque).norm(), 1e-6)
              << to_text(measure);
        }
        deepest = std::max(deepest, forces.totals.deepest);
      }
      EXPECT_GT(deepest, 0.005);
    }
  }
}

/// Number of pairs evaluated in 250 ticks whose forces are compared with those of all pairs.
std::int64_t expect_forces_of_all_pairs(int threads, const Capacities& limits, bool crowded) {
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

// Several moving bodies, against each other and against fixed ones.
TEST(Coprocessor, SkippingPairsChangesNoForce) {
  const test::Crowd crowd(seed);
  const auto all = static_cast<std::int64_t>(250 * crowd.world.pairs().size());
  for (const int threads : {0, 1, 2}) {
    EXPECT_LT(expect_forces_of_all_pairs(threads, {}, false), all / 3) << threads << " threads";
  }
}

/// Statistics of ticks whose forces with and without skipping were compared.
struct Compared {
  std::int64_t evaluated = 0;
  std::int64_t of = 0;      ///< pairs evaluated without skipping
  double deepest = 0.0;     ///< [m] least signed distance
  std::int64_t pushed = 0;  ///< ticks with a force
};

/// Compares the ticks of a motion, with and without skipping, bitwise. @param make builds the same
/// model each time
template <class Make>
void expect_same_bits_with_every_pair(const Make& make, int threads, int ticks, Compared& sum) {
  auto model = make();
  auto same = make();
  CoprocessorOptions options = lock_step(threads);
  Coprocessor skipping(model.world, options);
  options.every_pair = true;
  Coprocessor plain(same.world, options);
  for (int tick = 0; tick < ticks; ++tick) {
    SCOPED_TRACE("tick " + std::to_string(tick));
    model.move();
    same.move();
    const PairForces& forces = skipping.exchange();
    const PairForces& all = plain.exchange();
    for (std::size_t body = 0; body < all.on_body.size(); ++body) {
      ASSERT_TRUE(same_bits(forces.on_body[body].force, all.on_body[body].force));
      ASSERT_TRUE(same_bits(forces.on_body[body].torque, all.on_body[body].torque));
    }
    ASSERT_EQ(forces.totals.peak_force, all.totals.peak_force);
    sum.evaluated += forces.totals.evaluated;
    sum.of += all.totals.evaluated;
    sum.deepest = std::min(sum.deepest, forces.totals.nearest);
    sum.pushed += forces.totals.peak_force > 0.0 ? 1 : 0;
  }
}

// How often a pair is evaluated out of range has no effect on its force.
TEST(Coprocessor, SkippingChangesNoBit) {
  for (const int threads : {0, 2}) {
    Compared boxes, crowd;
    for (unsigned run = 0; run < 4; ++run) {
      SCOPED_TRACE(families::of_seed(seed + run, "threads", threads));
      expect_same_bits_with_every_pair(
          [&] { return test::Boxes(4, 60, {.range = 0.03}, seed + run); }, threads, 300, boxes);
      expect_same_bits_with_every_pair(
          [&] { return test::Crowd(seed + run, {}, test::random_shape); }, threads, 300, crowd);
      if (HasFailure()) return;
    }
    for (const Compared& sample : {boxes, crowd}) {
      EXPECT_LT(sample.evaluated, sample.of / 3);
      EXPECT_GT(sample.pushed, 4 * 300 / 2);
      EXPECT_LT(sample.deepest, -0.01);
    }
  }
}

TEST(Coprocessor, ForcesAreThoseOfAllPairsWhenMemoryIsShort) {
  for (const int candidates : {0, 4, 10}) {
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

/// The same pairs evaluated with threads and by the caller alone, on one motion.
struct Both {
  explicit Both(const CoprocessorOptions& options, int obstacles = 40)
      : boxes(4, obstacles, {.range = 0.2}, seed),
        here(boxes.world, lock_step(0)),
        there(boxes.world, options) {}

  /// One tick together; the forces must be those of its motion, whichever thread computed them.
  void tick() {
    boxes.move();
    const PairForces& expected = here.exchange();
    expect_same_forces(expected, there.exchange());
  }
  /// One tick beside; an answer that is not widened must be that of its motion.
  void tick_beside() {
    boxes.move();
    const PairForces& expected = here.exchange();
    const PairForces& forces = there.exchange();
    EXPECT_EQ(forces.tick, boxes.world.motion().tick);
    if (there.workers().age == 0) expect_same_forces(expected, forces);
  }
  void expect_same_forces(const PairForces& expected, const PairForces& forces) const {
    EXPECT_EQ(forces.tick, boxes.world.motion().tick);
    EXPECT_EQ(forces.totals.evaluated, forces.totals.near);
    for (std::size_t body = 0; body < expected.on_body.size(); ++body) {
      const Wrench& F = expected.on_body[body];
      const Wrench& G = forces.on_body[body];
      EXPECT_LE((F.force - G.force).norm(), 1e-9 * (1.0 + F.force.norm())) << "seed " << seed;
      EXPECT_LE((F.torque - G.torque).norm(), 1e-9 * (1.0 + F.torque.norm())) << "seed " << seed;
    }
  }
  test::Boxes boxes;
  Coprocessor here;
  Coprocessor there;
};

TEST(Coprocessor, WhoeverIsLateTheForcesAreThoseOfThisMotion) {
  CoprocessorOptions options;
  options.threads = 1;
  options.processors = 2;
  options.patience = 0ns;
  Both both(options, 1000);
  // No patience: sooner or later a thread is within a batch when the caller has no more to do.
  std::int64_t late = 0;
  EXPECT_TRUE(comes_true([&] {
    both.tick();
    late += both.there.late() ? 1 : 0;
    EXPECT_EQ(both.there.workers().stood_in, both.there.late() ? 1 : 0);
    EXPECT_EQ(both.there.workers().ticks, late);
    return late > 3;
  }));
}

TEST(Coprocessor, NoPatienceAndNoPeriodAreDefined) {
  constexpr auto most = std::chrono::nanoseconds::max();
  const std::pair<std::chrono::nanoseconds, std::chrono::nanoseconds> waits[] = {
      {0ns, 0ns}, {-1s, -1s}, {-most, most}, {most, -most}};
  for (const auto& [patience, period] : waits) {
    for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
      CoprocessorOptions options;
      options.threads = 2;
      options.mode = mode;
      options.processors = 3;
      options.patience = patience;
      options.period = period;
      Both both(options);
      for (int tick = 0; tick < 20; ++tick) both.tick_beside();
    }
  }
}

// A thread that has no processor of its own would only take that of the caller.
TEST(Coprocessor, StartsNoMoreThreadsThanHaveProcessorsAndPairs) {
  const test::Boxes boxes(4, 48, {}, seed);  // enough for three threads
  for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
    for (const int processors : {1, 2, 3, 8}) {
      CoprocessorOptions options;
      options.threads = 3;
      options.mode = mode;
      options.processors = processors;
      const int least = mode == CoprocessorMode::beside ? 1 : 0;
      EXPECT_EQ(Coprocessor(boxes.world, options).threads(), std::clamp(processors - 1, least, 3));
    }
    const World empty;
    EXPECT_EQ(Coprocessor(empty, beside(2)).threads(), 0);
    const test::Boxes few(1, 63, {}, seed);
    EXPECT_EQ(Coprocessor(few.world, lock_step(2)).threads(), 0);
    EXPECT_EQ(Coprocessor(few.world, beside(2)).threads(), 1);
  }
}

/// Threads that register themselves, so that a signal can be sent to one.
struct Threads {
  static inline std::atomic<pthread_t> ids[2];
  static inline std::atomic<int> started{0};
  static inline std::atomic<int> caught{0};
  static inline std::atomic<bool> held{false};
  static inline std::atomic<int> gone_on{0};

  /// @param handler of SIGUSR1 while this object lives
  explicit Threads(void (*handler)(int)) {
    started = 0;
    caught = 0;
    gone_on = 0;
    struct sigaction action {};
    action.sa_handler = handler;
    sigaction(SIGUSR1, &action, &before_);
  }
  ~Threads() { sigaction(SIGUSR1, &before_, nullptr); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  [[nodiscard]] static CoprocessorOptions options(
      int threads, CoprocessorMode mode = CoprocessorMode::together) {
    CoprocessorOptions options;
    options.threads = threads;
    options.mode = mode;
    options.processors = threads + 1;
    options.period = 1ms;
    options.patience = 5ms;
    options.on_thread_start = [](int index) noexcept {
      ids[index] = pthread_self();
      ++started;
    };
    return options;
  }
  /// Sends the signal to a thread at some moment while `meanwhile` is called again and again.
  /// Returns when it is handled.
  template <class Meanwhile>
  [[nodiscard]] static bool strike(int index, Meanwhile&& meanwhile) {
    const int before = caught;
    held = true;
    const std::jthread sender([index] {
      std::this_thread::sleep_for(1ms);
      pthread_kill(ids[index], SIGUSR1);
    });
    const auto until = std::chrono::steady_clock::now() + 60s;
    while (caught == before && std::chrono::steady_clock::now() < until) meanwhile();
    return caught > before;
  }

  static void hold(int /*signal*/) {
    ++caught;
    const timespec moment{0, 100000};
    while (held) nanosleep(&moment, nullptr);
    ++gone_on;
  }
  /// Lets a held thread go on.
  [[nodiscard]] static bool release() {
    held = false;
    return comes_true([] { return gone_on == caught; });
  }
  /// Ends this thread only, without any notification.
  static void leave(int /*signal*/) {
    ++caught;
    syscall(SYS_exit, 0);
  }

 private:
  struct sigaction before_ {};
};

// At any point: in the middle of a pair, between batches, asleep.
TEST(Coprocessor, StalledThreadIsStoodInForUntilItGoesOn) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer hands over a signal only outside of a batch";
#endif
  for (const int threads : {1, 2}) {
    const Threads watched(&Threads::hold);
    Both both(Threads::options(threads), 400);
    ASSERT_TRUE(comes_true([&] { return Threads::started == threads; }));
    int stalls = 0;  // within a batch; elsewhere nobody waits for it
    EXPECT_TRUE(comes_true([&] {
      both.tick();
      EXPECT_TRUE(Threads::strike(threads - 1, [&] { both.tick(); }));
      const std::int64_t silence = both.there.workers().silence;
      const std::int64_t before = both.there.workers().ticks;
      int late = 0;
      while (late < 10 && (both.tick(), both.there.late())) {
        ++late;
        EXPECT_EQ(both.there.workers().silence, silence + late);
        EXPECT_EQ(both.there.workers().ticks, before + late);
      }
      // What ends before the thread goes on was another one, taken off its processor.
      stalls += late == 10 ? 1 : 0;
      EXPECT_TRUE(Threads::release());
      return stalls >= 1 || HasFailure();
    }));
    EXPECT_TRUE(comes_true([&] {
      both.tick();
      return !both.there.late();
    }));
    EXPECT_GE(both.there.workers().longest_silence, 10);
  }
}

// One stalled for longer than the caller once waited, 1 s, or half a second outside of a batch, was
// given up: is_past() then answered by the clock, and a run in lock step came out otherwise.
TEST(Coprocessor, InLockStepStalledThreadIsWaitedForHoweverLong) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer hands over a signal only outside of a batch";
#endif
  for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(std::string(to_text(mode)) + ", threads " + std::to_string(threads));
      const Threads watched([](int) {
        ++Threads::caught;
        const timespec stall{1, 300000000};
        nanosleep(&stall, nullptr);
        ++Threads::gone_on;
      });
      CoprocessorOptions options = Threads::options(threads, mode);
      options.lock_step = true;
      Both both(options, 400);
      ASSERT_TRUE(comes_true([&] { return Threads::started == threads; }));
      int ticks = 0;
      const auto tick = [&] {
        both.boxes.move();
        EXPECT_TRUE(both.there.is_past(ticks)) << "at tick " << ticks;
        ++ticks;
        const PairForces& expected = both.here.exchange();
        const PairForces& forces = both.there.exchange();
        EXPECT_FALSE(both.there.late()) << "at tick " << ticks;
        EXPECT_EQ(both.there.workers().age, mode == CoprocessorMode::beside ? 1 : 0);
        if (mode == CoprocessorMode::together) both.expect_same_forces(expected, forces);
      };
      EXPECT_TRUE(Threads::strike(threads - 1, tick));
      EXPECT_TRUE(comes_true([&] {
        tick();
        return Threads::gone_on == Threads::caught || HasFailure();
      }));
      EXPECT_EQ(both.there.usage().restarts, 0);
    }
  }
}

TEST(Coprocessor, KilledThreadIsReplaced) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer waits for every thread to say that it ends";
#endif
  for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
    for (const int threads : {1, 2}) {
      const Threads watched(&Threads::leave);
      Both both(Threads::options(threads, mode), 400);
      ASSERT_TRUE(comes_true([&] { return Threads::started == threads; }));
      for (int victim = 0; victim < threads; ++victim) {
        SCOPED_TRACE(std::string(to_text(mode)) + ", thread " + std::to_string(victim));
        const std::int64_t restarts = both.there.usage().restarts;
        const auto tick = [&] {
          mode == CoprocessorMode::together ? both.tick() : both.tick_beside();
        };
        ASSERT_TRUE(Threads::strike(victim, tick));
        EXPECT_TRUE(comes_true([&] {
          tick();
          return both.there.usage().restarts > restarts;
        }));
        EXPECT_TRUE(comes_true([&] {
          tick();
          return !both.there.late();
        }));
        const std::int64_t shared = both.there.workers().shared;
        EXPECT_TRUE(comes_true([&] {
          tick();
          return both.there.workers().shared > shared + 20 && !both.there.late();
        }));
      }
      both.there.stop();
      for (std::int32_t i = 0; i < 160 && mode == CoprocessorMode::together; ++i) {
        const double peak = both.here.extremes_of({i}).peak_force;
        EXPECT_NEAR(both.there.extremes_of({i}).peak_force, peak, 1e-9 * (1.0 + peak));
      }
    }
  }
}

/// Ten times as many pairs as the budget covers.
struct Overload {
  explicit Overload(int threads)
      : boxes(4, 64, {.range = 2.0}, seed), there(boxes.world, lock_step(threads, tenth())) {}

  void tick() {
    boxes.move();
    totals = there.exchange().totals;
    ASSERT_EQ(totals.near, 256);
    ASSERT_EQ(totals.evaluated + totals.stale, totals.near);
    ASSERT_GT(totals.evaluated, 0);
  }
  [[nodiscard]] Budget tenth() {
    Coprocessor all(boxes.world, lock_step(0));
    std::int64_t spent = 0;
    for (int tick = 0; tick < 10; ++tick) {
      boxes.move();
      spent += all.exchange().totals.iterations;
    }
    return {.work_units = spent / 100};
  }
  test::Boxes boxes;
  Coprocessor there;
  PairTotals totals;
};

TEST(Coprocessor, OverloadIsAnsweredInTurnAndEnds) {
  for (const int threads : {0, 2}) {
    Overload overload(threads);
    std::int64_t stale = 0;
    for (int tick = 0; tick < 300; ++tick) {
      overload.tick();
      ASSERT_LE(overload.totals.oldest_age, 64) << "tick " << tick << ", seed " << seed;
      stale += overload.totals.stale;
    }
    EXPECT_GT(stale, 300 * 128);
    Pose away = Pose::Identity();
    away.translation().x() = 10.0;
    World& world = overload.boxes.world;
    for (int tick = 0; tick <= 64; ++tick) {
      ++world.motion().tick;
      ASSERT_TRUE(world.place(overload.boxes.tool, away, {}));
      overload.totals = overload.there.exchange().totals;
    }
    EXPECT_EQ(overload.totals.stale, 0);
    EXPECT_EQ(overload.totals.near, 0);
    EXPECT_EQ(overload.totals.peak_force, 0.0);
  }
}

// Two bodies that move together keep their distance, however far they jump. A thread that saw them
// at different ticks would report another distance.
TEST(Coprocessor, ThreadsNeverSeeAMixOfTwoTicks) {
  World world;
  const BodyId a = world.add_body("a");
  const BodyId b = world.add_body("b");
  Pose X_BP = Pose::Identity();
  X_BP.translation().x() = 0.21;
  const PartId ball_a = world.add_part(a, "a", Shape::sphere(0.1));
  const PartId ball_b = world.add_part(b, "b", Shape::sphere(0.1), X_BP);
  for (int i = 0; i < 192; ++i) world.add_pair(ball_a, ball_b, {.range = 0.02});
  for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
    CoprocessorOptions options = lock_step(2);
    options.mode = mode;
    Coprocessor coprocessor(world, options);
    families::Rng random(seed);
    for (int tick = 0; tick < 2000; ++tick) {
      Pose X = Pose::Identity();
      X.translation() = families::uniform(random, 0.0, 5.0) * families::direction(random);
      world.motion().tick = tick;
      ASSERT_TRUE(world.place(a, X, {}) && world.place(b, X, {}));
      const PairForces& forces = coprocessor.exchange();
      ASSERT_FALSE(coprocessor.late());
      ASSERT_NEAR(forces.totals.nearest, 0.01, 1e-9) << "tick " << tick << ", seed " << seed;
      ASSERT_NEAR(forces.totals.peak_force, 25.0, 1e-6) << "tick " << tick << ", seed " << seed;
    }
    EXPECT_EQ(coprocessor.workers().age, mode == CoprocessorMode::beside ? 1 : 0);
  }
}

TEST(CoprocessorBeside, AnyNumberOfThreadsGivesTheSameBits) {
  const auto one = replay(beside(1));
  for (const int threads : {2, 3}) expect_same_bits(one, replay(beside(threads)), threads);
}

// The answer is one tick old, and the distance used never larger than the true one.
TEST(CoprocessorBeside, ForcesErrToTheSafeSide) {
  // Single points: the mean over a patch may be a little farther than its nearest point.
  constexpr ForceLaw law{.range = 0.3, .surface_force = 100.0, .damping = 0.0, .tilt = 0.0};
  int pushed = 0;
  for (unsigned run = 0; run < 10; ++run) {
    test::Boxes boxes(1, 1, law, seed + run);
    Coprocessor coprocessor(boxes.world, beside(1));
    const Pair& pair = boxes.world.pairs().front();
    for (int tick = 0; tick < 200; ++tick) {
      boxes.move();
      const double felt = coprocessor.exchange().on_body[boxes.tool.index].force.norm();
      EXPECT_EQ(coprocessor.workers().age, 1);
      const double truth = pair.law(test::separation_now(boxes.world, pair).distance, 0.0);
      ASSERT_GE(felt, truth - 1e-9) << "tick " << tick << ", seed " << seed + run;
      pushed += truth > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(pushed, 100) << "seed " << seed;
}

TEST(CoprocessorBeside, AtRestTheForcesAreThoseOfADirectEvaluation) {
  test::Boxes boxes(4, 60, {.range = 0.05}, seed);
  Coprocessor coprocessor(boxes.world, beside(2));
  double most = 0.0;
  for (int tick = 0; tick < 100; ++tick) {
    boxes.move();
    (void)coprocessor.exchange();
    ++boxes.world.motion().tick;
    const PairForces& forces = coprocessor.exchange();
    const auto direct = test::forces_now(boxes.world);
    for (std::size_t body = 0; body < direct.size(); ++body) {
      ASSERT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-6);
      ASSERT_LE((forces.on_body[body].torque - direct[body].torque).norm(), 1e-6);
    }
    most = std::max(most, forces.totals.peak_force);
  }
  EXPECT_GT(most, 10.0) << "seed " << seed;
}

// Slowly enough for the lookahead, a wall is felt at the very tick at which its range begins.
TEST(CoprocessorBeside, PairThatComesIntoRangeIsNotMissed) {
  World world;
  const BodyId tool = world.add_body("tool");
  Pose X = Pose::Identity();
  X.translation().x() = -0.5;
  const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.1));
  const PartId wall = world.add_part(World::fixed, "wall", Shape::box({0.1, 1.0, 1.0}));
  world.add_pair(ball, wall, {.range = 0.02, .surface_force = 100.0, .damping = 0.0});
  ASSERT_TRUE(world.place(tool, X, {}));
  Coprocessor coprocessor(world, beside(1));
  bool was_felt = false;
  for (int tick = 0; tick < 160; ++tick) {
    X.translation().x() += 0.8 / 400.0;
    world.motion().tick = tick;
    ASSERT_TRUE(world.place(tool, X, {{0.8, 0.0, 0.0}, {}}));
    const double distance = -X.translation().x() - 0.2;
    const bool is_felt = coprocessor.exchange().totals.peak_force > 0.0;
    EXPECT_EQ(is_felt, distance < 0.02) << "at " << distance << " m";
    was_felt = was_felt || is_felt;
  }
  EXPECT_TRUE(was_felt);
}

TEST(CoprocessorBeside, StalledThreadIsStoodInForUntilItGoesOn) {
  const Threads watched(&Threads::hold);
  Both both(Threads::options(1, CoprocessorMode::beside));
  ASSERT_TRUE(comes_true([&] { return Threads::started == 1; }));
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(comes_true([&] {
      both.tick_beside();
      return !both.there.late();
    }));
    ASSERT_TRUE(Threads::strike(0, [&] { both.tick_beside(); }));
    for (int k = 0; k < 20; ++k) {
      both.tick_beside();
      EXPECT_LE(both.there.workers().age, Coprocessor::greatest_age);
    }
    EXPECT_TRUE(both.there.late());
    EXPECT_GE(both.there.workers().silence, 20 - Coprocessor::greatest_age);
    EXPECT_TRUE(Threads::release());
  }
}

TEST(CoprocessorBeside, PairsWithoutMemoryAreEvaluatedByTheCaller) {
  test::Crowd crowd(seed, {.candidates = 4});
  Coprocessor coprocessor(crowd.world, beside(1));
  int crowded = 0;
  for (int tick = 0; tick < 250; ++tick) {
    crowd.move();
    const PairForces& forces = coprocessor.exchange();
    crowded += forces.totals.crowded > 0 ? 1 : 0;
    if (coprocessor.workers().age > 0) continue;
    const auto direct = test::forces_now(crowd.world);
    for (std::size_t body = 0; body < direct.size(); ++body) {
      ASSERT_LE((forces.on_body[body].force - direct[body].force).norm(), 1e-9);
    }
  }
  EXPECT_GT(crowded, 200) << "seed " << seed;
}

TEST(CoprocessorBeside, ShowsWhatItUsed) {
  test::Boxes boxes(4, 60, {.range = 0.05}, seed);
  Coprocessor coprocessor(boxes.world, beside(1));
  for (int tick = 0; tick < 50; ++tick) {
    boxes.move();
    const PairForces& forces = coprocessor.exchange();
    double peak = 0.0;
    coprocessor.for_each_near([&](const NearPair& near) {
      peak = std::max(peak, near.force);
      EXPECT_GE(near.age, 1);
      EXPECT_EQ(coprocessor.separation_of(near.pair).distance, near.separation.distance);
    });
    EXPECT_EQ(peak, forces.totals.peak_force);
  }
}

}  // namespace coprocessor_test
}  // namespace repel
