// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/thread_usage.hpp>

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace repel::detail {
namespace thread_usage_test {

TEST(ThreadUsage, CountsThePageFaultsOfTheThreadThatIsWatched) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer's shadow memory has faults of its own";
#endif
#ifndef __linux__
  GTEST_SKIP() << "nothing is counted here";
#endif
  ThreadUsage usage;
  EXPECT_EQ(usage.look().page_faults, 0);  // of no thread yet
  std::int64_t before = 0, after = 0;
  std::thread([&] {
    usage.attach_to_this_thread();
    before = usage.look().page_faults;
    const std::vector<char> fresh(std::size_t{16} << 20, 1);
    after = usage.look().page_faults;
    EXPECT_EQ(fresh.back(), 1);
  }).join();
  EXPECT_GT(after, before);
  // What is known of a thread that has ended stays.
  EXPECT_EQ(usage.look().page_faults, after);
}

TEST(ThreadUsage, CountsSwitchesOfAThreadWithWork) {
#ifndef __linux__
  GTEST_SKIP() << "nothing is counted here";
#endif
  // More busy threads than processors, for long enough: some are switched.
  std::vector<std::thread> busy;
  std::vector<ThreadUsage> usages(4 * std::max(1U, std::thread::hardware_concurrency()));
  std::atomic<bool> ends{false};
  std::atomic<std::int64_t> switches{0};
  for (ThreadUsage& usage : usages) {
    busy.emplace_back([&] {
      usage.attach_to_this_thread();
      while (!ends) {
      }
      switches += usage.look().switches;
    });
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ends = true;
  for (std::thread& thread : busy) thread.join();
  EXPECT_GT(switches, 0);
}

}  // namespace thread_usage_test
}  // namespace repel::detail
