// SPDX-License-Identifier: BSD-3-Clause
// One writer thread and one reader thread, as in the tick. The payload is not atomic, so that the
// thread sanitizer also verifies the memory ordering of the exchange.
#include <repel/base/mailbox.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

namespace repel {
namespace mailbox_test {

using Payload = std::array<long, 64>;

TEST(Mailbox, HoldsThePrototypeAndNothingNewAtFirst) {
  Mailbox<int> box(7);
  EXPECT_FALSE(box.take());
  EXPECT_EQ(box.newest(), 7);
}

TEST(Mailbox, GivesEachPostOnce) {
  Mailbox<int> box(0);
  for (int i = 1; i <= 10; ++i) {
    box.draft() = i;
    box.post();
    ASSERT_TRUE(box.take());
    EXPECT_EQ(box.newest(), i);
    EXPECT_FALSE(box.take());
    EXPECT_EQ(box.newest(), i);
  }
}

TEST(Mailbox, TheNewestOfSeveralPostsWins) {
  Mailbox<int> box(0);
  for (int posts = 1; posts <= 7; ++posts) {
    for (int i = 0; i < posts; ++i) {
      box.draft() = 100 * posts + i;
      box.post();
    }
    ASSERT_TRUE(box.take());
    EXPECT_EQ(box.newest(), 100 * posts + posts - 1);
    EXPECT_FALSE(box.take());
  }
}

TEST(Mailbox, ADraftIsNotSeenBeforeItIsPosted) {
  Mailbox<int> box(1);
  box.draft() = 2;
  EXPECT_FALSE(box.take());
  EXPECT_EQ(box.newest(), 1);
}

TEST(Mailbox, WritingGoesOnWhileTheReaderHoldsAValue) {
  Mailbox<int> box(0);
  box.draft() = 1;
  box.post();
  ASSERT_TRUE(box.take());
  const int& held = box.newest();
  for (int i = 2; i < 100; ++i) {
    box.draft() = i;
    box.post();
    EXPECT_EQ(held, 1);
  }
}

TEST(Mailbox, ValuesAreNeverTornAndNeverRunBackwards) {
  constexpr int enough = 2000;
  Mailbox<Payload> box(Payload{});
  // Relaxed, so that only the mailbox orders memory between the two threads.
  std::atomic<int> taken{0};
  std::atomic<long> last_posted{0};
  std::thread writer([&] {
    long value = 0;
    while (taken.load(std::memory_order_relaxed) < enough) {
      box.draft().fill(++value);
      box.post();
      if (value % 256 == 0) std::this_thread::yield();
    }
    last_posted.store(value, std::memory_order_relaxed);
  });
  long before = 0;
  int torn = 0;
  int backwards = 0;
  while (taken.load(std::memory_order_relaxed) < enough) {
    if (!box.take()) {
      std::this_thread::yield();
      continue;
    }
    const Payload& now = box.newest();
    torn += std::all_of(now.begin(), now.end(), [&](long x) { return x == now[0]; }) ? 0 : 1;
    backwards += now[0] > before ? 0 : 1;
    before = now[0];
    taken.fetch_add(1, std::memory_order_relaxed);
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
  EXPECT_TRUE(box.take() || before == last_posted);
  EXPECT_EQ(box.newest()[0], last_posted);
}

}  // namespace mailbox_test
}  // namespace repel
