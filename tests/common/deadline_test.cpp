// SPDX-License-Identifier: BSD-3-Clause
#include <repel/common/deadline.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace repel {
namespace deadline_test {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;
constexpr unsigned seed = 400;

TEST(DurationHistogram, PercentilesAreRightToOnePointSixPercent) {
  std::mt19937_64 random(seed);
  for (int run = 0; run < 30; ++run) {
    // From fractions of a microsecond to a second, on a different scale in each run.
    std::lognormal_distribution<double> durations(
        std::uniform_real_distribution<double>(std::log(200.0), std::log(1e8))(random), 1.5);
    DurationHistogram histogram;
    std::vector<double> exact;
    for (int i = 0; i < 2000; ++i) {
      const nanoseconds sample(std::llround(std::min(4e9, durations(random))));
      histogram.record(sample);
      exact.push_back(1e-3 * static_cast<double>(sample.count()));
    }
    std::sort(exact.begin(), exact.end());
    for (const double p : {0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::ceil(p * 2000.0 - 1e-9)) - 1;
      ASSERT_NEAR(histogram.percentile_us(p), exact[rank], 0.016 * exact[rank])
          << "p " << p << ", run " << run << ", seed " << seed;
    }
    EXPECT_EQ(histogram.max_us(), exact.back());
    EXPECT_EQ(histogram.count(), 2000);
  }
}

TEST(DurationHistogram, ShortDurationsAreExactToTheNanosecond) {
  DurationHistogram histogram;
  for (int ns = 0; ns < 64; ++ns) histogram.record(nanoseconds(ns));
  for (int ns = 0; ns < 64; ++ns) {
    EXPECT_DOUBLE_EQ(histogram.percentile_us((ns + 1) / 64.0), 1e-3 * ns);
  }
}

TEST(DurationHistogram, MaximumIsExactHoweverLong) {
  DurationHistogram histogram;
  histogram.record(1us);
  histogram.record(3600s);
  EXPECT_EQ(histogram.max_us(), 3.6e9);
  EXPECT_DOUBLE_EQ(histogram.percentile_us(0.5), 1.007);  // the upper edge of its bin
}

TEST(DurationHistogram, NegativeDurationsCountAsNone) {
  DurationHistogram histogram;
  histogram.record(-5us);
  EXPECT_EQ(histogram.count(), 1);
  EXPECT_EQ(histogram.max_us(), 0.0);
  EXPECT_EQ(histogram.percentile_us(1.0), 0.0);
}

TEST(DurationHistogram, SumsUpAsIfAllHadBeenRecordedInOne) {
  std::mt19937_64 random(seed);
  std::array<DurationHistogram, 2> parts;
  DurationHistogram all;
  for (int i = 0; i < 1000; ++i) {
    const nanoseconds sample(static_cast<std::int64_t>(random() % 10'000'000));
    parts[random() % 3 == 0 ? 0 : 1].record(sample);
    all.record(sample);
  }
  DurationHistogram sum;
  for (const DurationHistogram& part : parts) sum.add(part);
  EXPECT_EQ(sum.count(), 1000);
  EXPECT_EQ(sum.max_us(), all.max_us());
  for (const double p : {0.0, 0.1, 0.5, 0.99}) {
    EXPECT_EQ(sum.percentile_us(p), all.percentile_us(p)) << "p " << p << ", seed " << seed;
  }
}

TEST(DurationHistogram, EmptyOneAnswersZero) {
  const DurationHistogram histogram;
  EXPECT_EQ(histogram.percentile_us(0.99), 0.0);
  EXPECT_EQ(histogram.max_us(), 0.0);
}

TEST(DeadlineMonitor, MissesWhenLatenessAndComputeExceedThePeriod) {
  DeadlineMonitor monitor(1ms);
  monitor.record(400us, 600us);  // exactly on time
  EXPECT_EQ(monitor.misses(), 0);
  monitor.record(400us, 601us);
  monitor.record(0us, 2ms);
  monitor.record(2ms, 1us);
  EXPECT_EQ(monitor.misses(), 3);
  EXPECT_EQ(monitor.ticks(), 4);
  EXPECT_EQ(monitor.longest_response(), 2001us);
  EXPECT_EQ(monitor.compute().max_us(), 2000.0);
  EXPECT_EQ(monitor.wakeup().max_us(), 2000.0);
}

TEST(DeadlineMonitor, SuccessRateLooksBackOneHundredTicks) {
  std::mt19937_64 random(seed);
  DeadlineMonitor monitor(1ms);
  EXPECT_EQ(monitor.success_rate(), 1.0);
  std::vector<bool> missed;
  double lowest = 1.0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double share = tick / 250 % 2 == 0 ? 0.05 : 0.6;
    missed.push_back(std::bernoulli_distribution(share)(random));
    monitor.record(0ns, missed.back() ? 2ms : 100us);
    const auto window = std::min<std::ptrdiff_t>(100, static_cast<std::ptrdiff_t>(missed.size()));
    const auto recent = std::count(missed.end() - window, missed.end(), true);
    const double rate = 1.0 - static_cast<double>(recent) / static_cast<double>(window);
    ASSERT_DOUBLE_EQ(monitor.success_rate(), rate) << "tick " << tick << ", seed " << seed;
    lowest = std::min(lowest, rate);
    ASSERT_DOUBLE_EQ(monitor.lowest_success_rate(), lowest);
  }
  EXPECT_EQ(monitor.misses(), std::count(missed.begin(), missed.end(), true));
}

}  // namespace deadline_test
}  // namespace repel
