// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/channel.hpp>

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include <repel/base/setup_error.hpp>

#include "support/draws.hpp"

namespace repel::network {
namespace channel_test {

constexpr double period = 0.0025;

Channel<int> ready(const ChannelOptions& options) {
  Channel<int> channel(options);
  channel.prepare(period, -1);
  return channel;
}

TEST(Channel, DelaysEveryPacketByWholeTicks) {
  for (const int ticks : {1, 2, 7, 400}) {
    Channel<int> channel = ready({.delay = ticks * period});
    for (int tick = 0; tick < 1000; ++tick) {
      EXPECT_EQ(channel.newest(), tick < ticks ? -1 : tick - ticks);
      if (tick >= ticks) {
        EXPECT_EQ(channel.age(), ticks);
      }
      channel.send(tick);
      channel.advance();
    }
    EXPECT_EQ(channel.counts().overtaken + channel.counts().lost, 0);
  }
}

TEST(Channel, RoundsToTheNearestTickAndTakesOneAtLeast) {
  for (const auto& [delay, ticks] :
       {std::pair(0.0, 1), {0.1 * period, 1}, {1.4 * period, 1}, {1.6 * period, 2}}) {
    Channel<int> channel = ready({.delay = delay});
    channel.send(5);
    int waited = 0;
    for (; channel.newest() != 5 && waited < 10; ++waited) channel.advance();
    EXPECT_EQ(waited, ticks) << delay;
  }
}

TEST(Channel, SameSeedIsTheSameChannel) {
  const ChannelOptions options{.delay = 0.01, .jitter = 0.02, .loss = 0.2, .seed = 7};
  ChannelOptions other = options;
  other.seed = 8;
  Channel<int> one = ready(options);
  Channel<int> two = ready(options);
  Channel<int> three = ready(other);
  int differences = 0;
  for (int tick = 0; tick < 10000; ++tick) {
    for (Channel<int>* channel : {&one, &two, &three}) {
      channel->send(tick);
      channel->advance();
    }
    ASSERT_EQ(one.newest(), two.newest()) << "tick " << tick;
    differences += one.newest() != three.newest() ? 1 : 0;
  }
  EXPECT_EQ(one.counts().lost, two.counts().lost);
  EXPECT_GT(differences, 5000);
}

TEST(Channel, EveryPacketIsLostOrOvertakenOrArrivesOnceAndInOrder) {
  for (const double jitter : {0.0, 0.0025, 0.02, 0.0313}) {
    for (const double loss : {0.0, 0.1, 0.9, 1.0}) {
      SCOPED_TRACE("jitter " + std::to_string(jitter) + ", loss " + std::to_string(loss));
      Channel<int> channel = ready({.delay = 0.01, .jitter = jitter, .loss = loss});
      const int ticks = families::draws(200000);
      std::int64_t arrived = 0;
      int last = -1;
      for (int tick = 0; tick < ticks + 100; ++tick) {
        if (tick < ticks) channel.send(tick);
        channel.advance();
        ASSERT_GE(channel.newest(), last) << "tick " << tick;
        arrived += channel.newest() > last ? 1 : 0;
        last = channel.newest();
      }
      const auto& counts = channel.counts();
      EXPECT_EQ(counts.sent, ticks);
      EXPECT_EQ(counts.lost + counts.overtaken + arrived, counts.sent);
      EXPECT_NEAR(static_cast<double>(counts.lost), loss * ticks, 5.0 * std::sqrt(ticks));
      if (jitter == 0.0) {
        EXPECT_EQ(counts.overtaken, 0);
      }
      if (jitter > 0.01 && loss < 0.5) {
        EXPECT_GT(counts.overtaken, ticks / 10);
      }
    }
  }
}

// Packets so far apart that they do not affect each other.
TEST(Channel, JitterIsSpreadEvenlyAboveTheDelay) {
  Channel<int> channel = ready({.delay = 0.01, .jitter = 4 * period});
  std::array<int, 16> late{};
  const int packets = families::draws(100000);
  for (int packet = 0; packet < packets; ++packet) {
    channel.send(packet);
    int waited = 0;
    for (; channel.newest() != packet && waited < 15; ++waited) channel.advance();
    EXPECT_EQ(channel.age(), waited);
    ++late[static_cast<std::size_t>(waited)];
  }
  for (int waited = 0; waited < 16; ++waited) {
    const double expected = waited >= 4 && waited <= 8 ? 0.2 * packets : 0.0;
    EXPECT_NEAR(late[static_cast<std::size_t>(waited)], expected,
                expected > 0.0 ? 0.02 * packets : 0.0)
        << waited << " ticks";
  }
}

TEST(Channel, RefusesNumbersOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Channel<int>({.delay = -1.0}), SetupError);
  EXPECT_THROW(Channel<int>({.delay = 10.1}), SetupError);
  EXPECT_THROW(Channel<int>({.jitter = nan}), SetupError);
  EXPECT_THROW(Channel<int>({.loss = 1.1}), SetupError);
}

}  // namespace channel_test
}  // namespace repel::network
