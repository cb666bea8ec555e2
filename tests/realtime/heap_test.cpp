// Counts every heap call in this program. A separate program, since it defines its own malloc.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "loop/slider.hpp"
#include "pairs/boxes.hpp"
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
      options.lock_step = true;
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

}  // namespace heap_test
}  // namespace repel
