// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tick_clock.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace tick_clock_test {

using namespace std::chrono_literals;
constexpr std::chrono::nanoseconds period = 2500us;

TEST(TickClock, CountsOnePeriodForEveryTickThatIsOnTimeOrALittleLate) {
  TickClock clock(period, 100ms);
  std::int64_t sum = 0;
  for (int tick = 1; tick <= 1000; ++tick) {
    const auto late = tick % 3 == 0 ? 1800us : 0us;
    ASSERT_EQ(clock.step(tick * period + late), 0U);
    ASSERT_EQ(clock.elapsed(), 1);
    sum += clock.elapsed();
  }
  EXPECT_EQ(sum, 1000);
}

TEST(TickClock, ATickThatIsLateByPeriodsStandsForThoseThatAreMissing) {
  TickClock clock(period, 100ms);
  ASSERT_EQ(clock.step(period), 0U);
  ASSERT_EQ(clock.step(12 * period), 0U);
  EXPECT_EQ(clock.elapsed(), 11);
  ASSERT_EQ(clock.step(13 * period), 0U);
  EXPECT_EQ(clock.elapsed(), 1);
}

// The first tick at 0 was a fault: a program that counts its time from its start held for 0.75 s.
TEST(TickClock, AnyClockThatGrowsIsSoundFromItsFirstTickOn) {
  for (const auto begin : {-1h, 0h, 1h}) {
    TickClock clock(period, 100ms);
    for (int tick = 0; tick < 5; ++tick) {
      EXPECT_EQ(clock.step(begin + tick * period), 0U) << "tick " << tick;
      EXPECT_EQ(clock.elapsed(), 1);
    }
    EXPECT_EQ(clock.step(begin), status::clock_fault);
  }
}

TEST(TickClock, AGapLongerThanStatedIsAFaultOnce) {
  TickClock clock(period, 100ms);
  ASSERT_EQ(clock.step(1s), 0U);
  EXPECT_EQ(clock.step(1s + 100ms), 0U);
  EXPECT_EQ(clock.step(1s + 210ms), status::clock_gap);
  EXPECT_EQ(clock.elapsed(), 44);
  EXPECT_EQ(clock.step(1s + 212ms), 0U);
}

TEST(TickClock, APeriodLongerThanTheLongestGapIsNone) {
  TickClock clock(1s, 100ms);
  for (int tick = 1; tick < 10; ++tick) EXPECT_EQ(clock.step(tick * 1s), 0U);
}

TEST(TickClock, AClockThatStandsStillOrRunsBackIsAFaultAndCountsAnewAfterwards) {
  TickClock clock(period, 100ms);
  ASSERT_EQ(clock.step(1s), 0U);
  EXPECT_EQ(clock.step(1s), status::clock_fault);
  EXPECT_EQ(clock.step(std::chrono::nanoseconds::min()), status::clock_fault);
  EXPECT_EQ(clock.elapsed(), 1);
  EXPECT_EQ(clock.step(2s), 0U);
  EXPECT_EQ(clock.elapsed(), 1);
}

}  // namespace tick_clock_test
}  // namespace repel
