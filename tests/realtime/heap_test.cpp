// SPDX-License-Identifier: BSD-3-Clause
// Counts every heap call in this program. A separate program, since it defines its own malloc.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <vector>

#include <repel/schedule/world_changes.hpp>

#include "loop/slider.hpp"
#include "pairs/boxes.hpp"
#include "support/draws.hpp"
#include "support/heap_counter.hpp"

namespace repel {
namespace heap_test {

using test::calls;
using test::watched;

/// Counts this thread and those that `count_from_here` was called in, and makes Eigen refuse heap
/// allocation.
struct Watch {
  Watch() {
    Eigen::internal::set_is_malloc_allowed(false);
    test::is_counted = true;
    watched = true;
  }
  ~Watch() {
    watched = false;
    Eigen::internal::set_is_malloc_allowed(true);
  }
};

/// For `CoprocessorOptions::on_thread_start`. A thread of the coprocessor may begin long after
/// set-up, and before this it opens a file; the thread that looks after the others does so always.
void count_from_here(int /*index*/) noexcept {
  test::is_counted = true;
}

TEST(Heap, CounterSeesMallocFreeAndNew) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  // Through volatile pointers, so that the compiler cannot eliminate a pair of calls.
  calls = 0;
  test::is_counted = true;
  watched = true;
  int* volatile by_new = new int(1);
  delete by_new;
  void* volatile by_malloc = std::malloc(10);
  std::free(by_malloc);
  void* volatile aligned = ::operator new(64, std::align_val_t(64));
  ::operator delete(aligned, std::align_val_t(64));
  watched = false;
  EXPECT_EQ(calls, 6);
}

TEST(Heap, TickTakesNothingFromIt) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const int threads : {0, 2}) {
    CoprocessorOptions options;
    options.threads = threads;
    options.lock_step = true;
    options.on_thread_start = count_from_here;
    calls = 0;
    test::SliderCell cell(test::push(2.0, 0.1),
                          {.coprocessor = options, .effort_limit = 100.0, .walls = 200});
    double peak = 0.0;
    for (int tick = 0; tick < 700; ++tick) {
      cell.arm.spoilt = tick > 600 && tick < 610;  // covers the code paths of a fault, too
      const Watch watch;
      peak = std::max(peak, cell.tick(tick == 650 ? std::chrono::nanoseconds(0) : cell.period)
                                .virtual_force.force.norm());
    }
    EXPECT_EQ(calls, 0) << threads << " threads";
    EXPECT_GT(peak, 10.0);
  }
}

TEST(Heap, CoprocessorTakesNothingFromItWhateverItsBudget) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  using namespace std::chrono_literals;
  for (const Budget& budget : {Budget{}, Budget{.work_units = 30}, Budget{.wall = 10us}}) {
    for (const int threads : {0, 2}) {
      test::Boxes boxes(4, 60, {.range = 0.1}, 3);
      CoprocessorOptions options;
      options.threads = threads;
      options.budget = budget;
      options.lock_step = budget.wall == 0ns;  // which would not count
      options.processors = threads + 1;
      options.on_thread_start = count_from_here;
      calls = 0;
      Coprocessor coprocessor(boxes.world, options);
      int evaluated = 0;
      for (int tick = 0; tick < 200; ++tick) {
        const Watch watch;
        boxes.move();
        evaluated += coprocessor.exchange().totals.evaluated;
      }
      EXPECT_EQ(calls, 0) << threads << " threads";
      EXPECT_GT(evaluated, 0);
    }
  }
}

// Shapes are made and freed by whoever asks for them, here between the ticks.
TEST(Heap, PartsThatComeAndGoTakeNothingFromItInTheTick) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const int threads : {0, 2}) {
    test::Boxes boxes(4, 60, {.range = 0.1}, 3);
    World& world = boxes.world;
    const BodyId tool = world.part(world.pair({0}).a).body;
    const PartId finger = world.pair({0}).a;
    world.join(tool, tool);
    world.spare_held(tool);
    for (int i = 0; i < 16; ++i) {
      const PartId part = world.reserve("loose", Shape::sphere(0.01), 0.2);
      (void)world.add_pair(finger, part, {.range = 0.1});
    }
    CoprocessorOptions options;
    options.threads = threads;
    options.lock_step = true;
    options.on_thread_start = count_from_here;
    calls = 0;
    Coprocessor coprocessor(world, options);
    WorldChanges changes(world);
    std::vector<PartId> used;
    const auto at = [&](int k) {
      Pose X = world.motion().bodies[static_cast<std::size_t>(tool.index)].X_WB;
      X.translation() += Vec3(0.05 * (k % 5), 0.05 * (k % 3), 0.1);
      return X;
    };
    std::int64_t evaluated = 0;
    const int ticks = families::draws(4000);
    for (int tick = 0; tick < ticks; ++tick) {
      const PartId added =
          changes.add(Shape::box({0.02 + 0.001 * (tick % 50), 0.05, 0.05}), at(tick), 0.005);
      if (added.valid()) used.push_back(added);
      (void)changes.move(used[static_cast<std::size_t>(tick) % used.size()], at(tick + 1), 1.0);
      if (tick % 4 == 0) (void)changes.attach(used.back(), tool, 0.005);
      if (used.size() > 12) {
        (void)changes.remove(used.front(), 0.005);
        used.erase(used.begin());
      }
      const Watch watch;
      changes.apply(world, coprocessor);
      world.advance(0.0025);
      boxes.move();
      world.carry();
      evaluated += coprocessor.exchange().totals.evaluated;
    }
    EXPECT_EQ(calls, 0) << threads << " threads";
    EXPECT_GT(changes.counts().applied, 5 * ticks / 2) << "10 000 without a sanitizer";
    EXPECT_GT(evaluated, ticks);
    RecordProperty("applied", static_cast<int>(changes.counts().applied));
  }
}

}  // namespace heap_test
}  // namespace repel
