// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/impaired.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "link/joined.hpp"
#include "link/within.hpp"

namespace repel::link {
namespace impaired_test {

using std::chrono::steady_clock;

/// Sends `count` packets, 0.5 ms apart, and returns them as they arrive. None may arrive before its
/// time.
std::vector<std::uint64_t> sent_over(const network::ChannelOptions& channel, std::uint64_t count) {
  test::Path forth, back;
  const auto from = impaired(std::make_unique<test::Within>(forth, back), channel);
  std::vector<steady_clock::time_point> sent;
  std::vector<std::uint64_t> arrived;
  const std::chrono::duration<double> longest(channel.delay + channel.jitter + 0.02);
  auto last = steady_clock::now();
  network::RemotePacket packet{};
  // Once more when the time is over: the machine may have stood still until then.
  for (bool is_over = false; !is_over;) {
    is_over = sent.size() == count && steady_clock::now() - last >= longest;
    if (sent.size() < count) {
      last = steady_clock::now();
      packet.sequence = sent.size();
      EXPECT_TRUE(from->send(packet));
      sent.push_back(last);
    }
    (void)from->receive(packet);
    for (; !forth.packets.empty(); forth.packets.pop_front()) {
      arrived.push_back(forth.packets.front().sequence);
      const std::chrono::duration<double> took = steady_clock::now() - sent[arrived.back()];
      EXPECT_GE(took.count(), channel.delay);
    }
    from->wait(std::chrono::microseconds(500));
  }
  return arrived;
}

TEST(Impaired, DelaysAndKeepsTheOrderWithoutJitter) {
  const std::vector<std::uint64_t> arrived = sent_over({.delay = 0.03}, 100);
  ASSERT_EQ(arrived.size(), 100U);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_EQ(arrived[i], i);
}

TEST(Impaired, LosesAndScattersAsTheChannelSaysAndAlikeForASeed) {
  const network::ChannelOptions channel{.delay = 0.0, .jitter = 0.02, .loss = 0.2, .seed = 11};
  const std::vector<std::uint64_t> arrived = sent_over(channel, 1000);
  EXPECT_NEAR(static_cast<double>(arrived.size()), 800.0, 60.0);  // 4.7 sigma
  int overtaken = 0;
  for (std::size_t i = 1; i < arrived.size(); ++i) overtaken += arrived[i] < arrived[i - 1] ? 1 : 0;
  EXPECT_GT(overtaken, 100);
  std::vector<std::uint64_t> again = sent_over(channel, 1000);
  std::vector<std::uint64_t> once = arrived;
  std::sort(once.begin(), once.end());
  std::sort(again.begin(), again.end());
  EXPECT_EQ(once, again);
}

TEST(Impaired, ASideWhosePacketsAreDelayedIsHeardLateAndWhole) {
  test::Path forth, back;
  const network::ChannelOptions far{.delay = 0.02};
  test::JoinedSide site(1, impaired(std::make_unique<test::Within>(forth, back), far));
  test::JoinedSide station(2, impaired(std::make_unique<test::Within>(back, forth), far));
  test::tick_both(site, station, 400);
  site.thread.stop();
  station.thread.stop();
  test::expect_joined(site, station);
  test::expect_joined(station, site);
  EXPECT_GE(site.round_trips.percentile_us(0.5), 40e3);
}

TEST(Impaired, SaysWhatItDoes) {
  test::Path path;
  const auto transport = impaired(std::make_unique<test::Within>(path, path),
                                  {.delay = 0.05, .jitter = 0.005, .loss = 0.02});
  EXPECT_EQ(transport->name(), "within, delayed by 50 to 55 ms, 2 % lost");
}

TEST(Impaired, RefusesWhatIsNoChannel) {
  test::Path path;
  for (const network::ChannelOptions& channel :
       {network::ChannelOptions{.delay = -1.0}, network::ChannelOptions{.jitter = 11.0},
        network::ChannelOptions{.loss = std::numeric_limits<double>::quiet_NaN()}}) {
    EXPECT_THROW((void)impaired(std::make_unique<test::Within>(path, path), channel), SetupError);
  }
}

}  // namespace impaired_test
}  // namespace repel::link
