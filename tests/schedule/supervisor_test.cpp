// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/supervisor.hpp>

#include <gtest/gtest.h>

#include <atomic>

namespace repel::detail {
namespace supervisor_test {

TEST(Supervisor, CallsUntilItIsStopped) {
  std::atomic<int> calls{0};
  Supervisor supervisor;
  supervisor.start([&] { ++calls; });
  while (calls < 2) std::this_thread::yield();
  supervisor.stop();
  const int then = calls;
  std::this_thread::sleep_for(2 * Supervisor::interval);
  EXPECT_EQ(calls, then);
}

TEST(Watch, IsOverdueOnceAfterTenLooksAtTheSameValue) {
  Watch watch;
  for (const std::uint64_t value : {1U, 2U, 3U}) EXPECT_FALSE(watch.is_overdue(value));
  for (int look = 1; look < Watch::limit; ++look) EXPECT_FALSE(watch.is_overdue(3));
  EXPECT_TRUE(watch.is_overdue(3));
  EXPECT_FALSE(watch.is_overdue(3));
  EXPECT_FALSE(watch.is_overdue(4));
}

}  // namespace supervisor_test
}  // namespace repel::detail
