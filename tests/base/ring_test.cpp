// SPDX-License-Identifier: BSD-3-Clause
// One writer thread and one reader thread. The payload is not atomic, so that the thread sanitizer
// verifies the memory ordering of the exchange.
#include <repel/base/ring.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

namespace repel {
namespace ring_test {

using Payload = std::array<long, 32>;

TEST(Ring, IsEmptyAtFirst) {
  Ring<int> ring(3, 7);
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_EQ(ring.draft(), 7);
  EXPECT_EQ(ring.dropped(), 0);
}

TEST(Ring, GivesEveryValueOnceInOrder) {
  Ring<int> ring(3, 0);
  int next = 0;
  for (int posted = 1; posted <= 20; ++posted) {
    ring.draft() = posted;
    ASSERT_TRUE(ring.post());
    if (posted % 3 != 0) continue;
    while (ring.front() != nullptr) {
      EXPECT_EQ(*ring.front(), ++next);
      ring.pop();
    }
  }
  EXPECT_EQ(next, 18);
}

TEST(Ring, DropsAndCountsWhatFindsNoRoomAndKeepsTheRest) {
  Ring<int> ring(3, 0);
  for (int value = 1; value <= 5; ++value) {
    ring.draft() = value;
    EXPECT_EQ(ring.post(), value <= 3);
  }
  EXPECT_EQ(ring.dropped(), 2);
  for (int value = 1; value <= 3; ++value) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), value);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
  ring.draft() = 6;
  EXPECT_TRUE(ring.post());
  EXPECT_EQ(*ring.front(), 6);
}

TEST(Ring, CapacityOutOfRangeIsRefused) {
  EXPECT_THROW(Ring<int>(0, 0), SetupError);
  EXPECT_THROW(Ring<int>(std::size_t{1} << 31, 0), SetupError);
}

TEST(Ring, BetweenThreadsEveryValueArrivesWholeOrIsCounted) {
  constexpr long last = 200000;
  Ring<Payload> ring(64, {});
  std::thread writer([&] {
    for (long i = 1; i <= last; ++i) {
      ring.draft().fill(i);
      while (!ring.post() && i == last)
        std::this_thread::yield();  // the reader waits for the last one
    }
  });
  long newest = 0;
  long seen = 0;
  while (newest < last) {
    const Payload* value = ring.front();
    if (value == nullptr) continue;
    ASSERT_TRUE(
        std::all_of(value->begin(), value->end(), [&](long v) { return v == (*value)[0]; }));
    ASSERT_GT((*value)[0], newest);
    newest = (*value)[0];
    ++seen;
    ring.pop();
  }
  writer.join();
  EXPECT_GE(seen + ring.dropped(), last);  // failed attempts to post the last one count as well
  EXPECT_GT(seen, 64);
}

}  // namespace ring_test
}  // namespace repel
