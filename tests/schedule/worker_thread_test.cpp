// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/worker_thread.hpp>

#include <gtest/gtest.h>

#include "support/comes_true.hpp"

namespace repel::detail {
namespace worker_thread_test {

using namespace std::chrono_literals;
using test::comes_true;

// Whether it spins, naps or sleeps between two ticks, it comes back to look for work.
TEST(WorkerThread, LooksForWorkUntilItIsStopped) {
  for (const bool lock_step : {false, true}) {
    CoprocessorOptions options;
    options.lock_step = lock_step;
    const Pace pace(options.period);
    WorkerThread thread(options, 0, pace);
    std::atomic<int> wanted{0}, done{0};
    thread.start([&]() noexcept {
      if (done == wanted) return false;
      ++done;
      return true;
    });
    for (const auto pause : {0us, 100us, 3000us, 20000us}) {
      std::this_thread::sleep_for(pause);
      const std::uint64_t beats = thread.beats();
      ++wanted;
      EXPECT_TRUE(comes_true([&] { return done == wanted; }));
      EXPECT_TRUE(comes_true([&] { return thread.beats() > beats; }));
    }
    thread.stop();
    ++wanted;
    const std::uint64_t beats = thread.beats();
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(thread.beats(), beats);
    EXPECT_LT(done, wanted);
  }
}

TEST(Pace, IsTheIntervalOfTheLastTwoTicks) {
  Pace pace(7ms);
  EXPECT_EQ(pace.interval(), 7ms);
  pace.tick();
  EXPECT_EQ(pace.interval(), 7ms);
  const auto begun = pace.begun();
  std::this_thread::sleep_for(2ms);
  pace.tick();
  EXPECT_EQ(pace.interval(), pace.begun() - begun);
  EXPECT_GE(pace.interval(), 2ms);
}

}  // namespace worker_thread_test
}  // namespace repel::detail
