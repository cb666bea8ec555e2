// SPDX-License-Identifier: BSD-3-Clause
// Parsing of kernel events from fragments of any size.
#include <repel/devices/evdev_parser.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

namespace repel::devices {
namespace evdev_parser_test {

input_event event_at(std::int64_t seconds, std::int64_t microseconds, std::int32_t value) {
  input_event event{};
  event.input_event_sec = seconds;
  event.input_event_usec = microseconds;
  event.type = EV_ABS;
  event.code = ABS_X;
  event.value = value;
  return event;
}

TEST(EvdevParser, GivesTheSameEventsHoweverTheBytesAreCut) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 rng(seed);
  std::vector<input_event> events;
  for (std::int32_t i = 0; i < 200; ++i) events.push_back(event_at(100 + i, 999999, -i));
  const auto bytes = std::as_bytes(std::span(events));
  std::int32_t next = 0;
  EvdevParser parser;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t count = std::min<std::size_t>(rng() % 70, bytes.size() - begin);
    ASSERT_TRUE(parser.feed(bytes.subspan(begin, count), [&](const EvdevEvent& event) {
      EXPECT_EQ(event.time, std::chrono::seconds(100 + next) + std::chrono::microseconds(999999));
      EXPECT_EQ(event.type, EV_ABS);
      EXPECT_EQ(event.value, -next);
      ++next;
    }));
    begin += count;
    EXPECT_EQ(parser.held(), begin % EvdevParser::event_size);
  }
  EXPECT_EQ(next, 200);
}

TEST(EvdevParser, ATimeThatNoClockShowsBreaksItUntilReset) {
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const std::vector<input_event> wrong = {event_at(-1, 0, 0), event_at(1, -1, 0),
                                          event_at(1, 1000000, 0), event_at(most, 0, 0)};
  for (const input_event& event : wrong) {
    EvdevParser parser;
    int events = 0;
    const auto count = [&](const EvdevEvent&) { ++events; };
    EXPECT_FALSE(parser.feed(std::as_bytes(std::span(&event, 1)), count));
    const input_event sound = event_at(1, 0, 0);
    EXPECT_FALSE(parser.feed(std::as_bytes(std::span(&sound, 1)), count));
    EXPECT_EQ(events, 0);
    parser.reset();
    EXPECT_TRUE(parser.feed(std::as_bytes(std::span(&sound, 1)), count));
    EXPECT_EQ(events, 1);
  }
}

}  // namespace evdev_parser_test
}  // namespace repel::devices
