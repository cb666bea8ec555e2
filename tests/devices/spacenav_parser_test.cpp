// SPDX-License-Identifier: BSD-3-Clause
// Parsing of spacenavd events from fragments of any size, and of invalid data.
#include <repel/devices/spacenav_parser.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

#include <devices/fake_spacenavd.hpp>

namespace repel::devices {
namespace spacenav_parser_test {

using Kind = SpacenavEvent::Kind;

std::vector<std::byte> bytes_of(const std::vector<Packet>& packets) {
  const auto bytes = std::as_bytes(std::span(packets));
  return {bytes.begin(), bytes.end()};
}

bool accepts(const Packet& packet) {
  SpacenavParser parser;
  int events = 0;
  const bool sound = parser.feed(bytes_of({packet}), [&](const SpacenavEvent&) { ++events; });
  EXPECT_EQ(events, sound ? 1 : 0);
  EXPECT_EQ(parser.broken(), !sound);
  return sound;
}

TEST(SpacenavParser, ReadsMotionAndButtons) {
  std::vector<SpacenavEvent> events;
  SpacenavParser parser;
  const auto bytes = bytes_of({motion(1, -2, 3, -4, 5, -6), press(7), release(7)});
  ASSERT_TRUE(parser.feed(bytes, [&](const SpacenavEvent& event) { events.push_back(event); }));
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].kind, Kind::motion);
  EXPECT_EQ(events[0].axes, (std::array<std::int32_t, 6>{1, -2, 3, -4, 5, -6}));
  EXPECT_EQ(events[1].kind, Kind::press);
  EXPECT_EQ(events[1].button, 7);
  EXPECT_EQ(events[2].kind, Kind::release);
  EXPECT_EQ(events[2].button, 7);
}

TEST(SpacenavParser, GivesTheSameEventsHoweverTheBytesAreCut) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 rng(seed);
  std::vector<Packet> packets;
  for (std::int32_t i = 0; i < 200; ++i) packets.push_back(motion(i, -i, 2 * i));
  const std::vector<std::byte> bytes = bytes_of(packets);
  std::int32_t next = 0;
  SpacenavParser parser;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t count = std::min<std::size_t>(rng() % 100, bytes.size() - begin);
    const auto piece = std::span(bytes).subspan(begin, count);
    ASSERT_TRUE(parser.feed(piece, [&](const SpacenavEvent& event) {
      EXPECT_EQ(event.axes[0], next);
      EXPECT_EQ(event.axes[2], 2 * next);
      ++next;
    }));
    begin += count;
    EXPECT_EQ(parser.held(), begin % SpacenavParser::event_size);
  }
  EXPECT_EQ(next, 200);
}

TEST(SpacenavParser, RefusesWhatNoDaemonSends) {
  EXPECT_TRUE(accepts(motion(100000, -100000, 0)));
  EXPECT_FALSE(accepts(motion(100001, 0, 0)));
  EXPECT_FALSE(accepts(motion(0, 0, 0, 0, 0, std::numeric_limits<std::int32_t>::min())));
  EXPECT_TRUE(accepts(press(255)));
  EXPECT_FALSE(accepts(press(256)));
  EXPECT_FALSE(accepts(release(-1)));
  EXPECT_TRUE(accepts({3, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(accepts({6, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(accepts({7, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(accepts({-1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(accepts({0x7faa5501, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(SpacenavParser, SaysNothingMoreOnceBrokenUntilReset) {
  SpacenavParser parser;
  int events = 0;
  const auto count = [&](const SpacenavEvent&) { ++events; };
  EXPECT_FALSE(parser.feed(bytes_of({motion(1, 2, 3), {9}, motion(4, 5, 6)}), count));
  EXPECT_EQ(events, 1);
  EXPECT_FALSE(parser.feed(bytes_of({motion(1, 2, 3)}), count));
  EXPECT_EQ(events, 1);
  parser.reset();
  EXPECT_TRUE(parser.feed(bytes_of({motion(1, 2, 3)}), count));
  EXPECT_EQ(events, 2);
}

}  // namespace spacenav_parser_test
}  // namespace repel::devices
