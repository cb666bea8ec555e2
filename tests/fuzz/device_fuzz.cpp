// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes in fragments of any size: both device parsers give the same events as without
// fragmentation, only plausible ones, and none after an error; all values derived from them stay in
// range.
#include <repel/devices/evdev_parser.hpp>
#include <repel/devices/lever_motion.hpp>
#include <repel/devices/shaping.hpp>
#include <repel/devices/spacenav_parser.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include <fuzz/bytes.hpp>

namespace repel::devices {
namespace {

using fuzz::Bytes;
using fuzz::require;

/// The bytes of a device: almost valid records, or arbitrary bytes.
template <std::size_t size, class Dress>
std::vector<std::byte> stream_of(Bytes& bytes, const Dress& dress) {
  const bool dressed = bytes.take<std::uint8_t>() < 224;
  std::vector<std::byte> stream;
  for (int i = bytes.take<std::uint8_t>() % 12; i > 0; --i) {
    auto record = bytes.take<std::array<std::byte, size>>();
    if (dressed && bytes.take<std::uint8_t>() < 248) dress(record);
    stream.insert(stream.end(), record.begin(), record.end());
  }
  if (!stream.empty()) stream.resize(stream.size() - bytes.take<std::uint8_t>() % size);
  return stream;
}

/// All events of the stream, fragmented as `bytes` says, or not at all.
template <class Parser, class Event>
bool events_of(const std::vector<std::byte>& stream, Bytes* bytes, std::vector<Event>& events) {
  Parser parser;
  bool sound = true;
  for (std::size_t begin = 0; begin < stream.size();) {
    const std::size_t rest = stream.size() - begin;
    const std::size_t most = bytes == nullptr ? rest : 1 + bytes->take<std::uint8_t>() % 80;
    const auto piece = std::span(stream).subspan(begin, std::min(rest, most));
    const std::size_t before = events.size();
    const bool was_sound = sound;
    sound = parser.feed(piece, [&](const Event& event) { events.push_back(event); });
    require(was_sound || (!sound && events.size() == before), "a broken parser says no more");
    require(parser.broken() == !sound, "it knows that it is broken");
    require(parser.held() < Parser::event_size, "it keeps less than an event");
    begin += piece.size();
  }
  return sound;
}

void check_spacenav(Bytes& bytes) {
  const auto stream = stream_of<SpacenavParser::event_size>(bytes, [](auto& record) {
    std::array<std::int32_t, 8> words{};
    std::memcpy(words.data(), record.data(), record.size());
    words[0] &= 7;
    for (std::size_t i = 1; i < words.size(); ++i) words[i] %= words[0] == 0 ? 120000 : 300;
    std::memcpy(record.data(), words.data(), record.size());
  });
  std::vector<SpacenavEvent> whole;
  std::vector<SpacenavEvent> cut;
  const bool sound = events_of<SpacenavParser>(stream, nullptr, whole);
  require(events_of<SpacenavParser>(stream, &bytes, cut) == sound, "pieces are as sound");
  require(whole.size() == cut.size(), "pieces give as many events");
  const Shaping shaping;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const SpacenavEvent& event = whole[i];
    require(event.kind == cut[i].kind && event.axes == cut[i].axes && event.button == cut[i].button,
            "pieces give the same events");
    std::array<double, 6> counts{};
    std::copy(event.axes.begin(), event.axes.end(), counts.begin());
    for (const double x : counts) require(std::abs(x) <= 100000.0, "an axis is sane");
    require(event.button >= 0 && event.button < 256, "a button is sane");
    const Twist twist = shaping.twist(counts);
    require(twist.linear.cwiseAbs().maxCoeff() <= 0.25, "no more than the scale");
    require(twist.angular.cwiseAbs().maxCoeff() <= 1.0, "no more than the scale");
  }
}

void check_evdev(Bytes& bytes) {
  const auto stream = stream_of<EvdevParser::event_size>(bytes, [](auto& record) {
    input_event event{};
    std::memcpy(&event, record.data(), record.size());
    event.input_event_sec &= 0xffff;
    event.input_event_usec &= 0xfffff;  // some are more than a second
    std::memcpy(record.data(), &event, record.size());
  });
  std::vector<EvdevEvent> whole;
  std::vector<EvdevEvent> cut;
  const bool sound = events_of<EvdevParser>(stream, nullptr, whole);
  require(events_of<EvdevParser>(stream, &bytes, cut) == sound, "pieces are as sound");
  require(whole.size() == cut.size(), "pieces give as many events");
  LeverMotion lever({.low = -1000, .high = 1000, .full_range = 2.0, .time_constant = 0.02});
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const EvdevEvent& event = whole[i];
    require(event.time == cut[i].time && event.type == cut[i].type && event.code == cut[i].code &&
                event.value == cut[i].value,
            "pieces give the same events");
    lever.move(event.value, event.time);
    require(std::abs(lever.angle()) <= 1.0, "the lever stays in its range");
    require(std::abs(lever.rate(event.time)) <= 20.0, "the rate is limited");
  }
}

}  // namespace
}  // namespace repel::devices

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::fuzz::Bytes bytes(data, size);
  if (bytes.take<std::uint8_t>() % 2 == 0) {
    repel::devices::check_spacenav(bytes);
  } else {
    repel::devices::check_evdev(bytes);
  }
  return 0;
}
