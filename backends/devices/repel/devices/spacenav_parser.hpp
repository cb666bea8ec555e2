// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parses the events of spacenavd from the bytes of its socket. Does no I/O.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <repel/devices/records.hpp>

namespace repel::devices {

/// An event of the daemon.
struct SpacenavEvent {
  /// What happened.
  enum class Kind {
    motion,   ///< `axes` hold from now on; all zero: at rest
    press,    ///< of `button`
    release,  ///< of `button`
    other,    ///< valid, but no input
  };
  Kind kind = Kind::other;             ///< which of these
  std::array<std::int32_t, 6> axes{};  ///< [counts] x, y, z, rx, ry, rz
  std::int32_t button = 0;             ///< from 0
};

/// Protocol version 0: every spacenavd uses it with a client sending no handshake (spacenavd
/// src/client.c: `proto = 0`, events of motion and buttons). Each event is 8 int32 in native byte
/// order (src/proto_unix.c, send_uevent):
///
///     0, x, y, z, rx, ry, rz, milliseconds since the last
///     1, button                                    pressed
///     2, button                                    released
///
/// The handshake of version 1, 0x7faa5501, is deliberately not sent: it would only add events on
/// devices and settings. An old daemon takes it for a sensitivity of NaN (libspnav src/spnav.c,
/// spnav_open, repairs that after 0.3 s of waiting). Types 3 to 6 are those of later versions:
/// devices, settings, raw axes, raw buttons (src/proto.h).
///
/// An impossible value invalidates the stream: the parser returns nothing until `reset`, as later
/// bytes may be misaligned and look like motion.
class SpacenavParser : public detail::Records<8 * sizeof(std::int32_t)> {
 public:
  static constexpr std::int32_t most_counts = 100000;  ///< largest plausible magnitude of an axis
  static constexpr std::int32_t most_buttons = 256;    ///< of one device

  /// Passes every complete event to `use(const SpacenavEvent&)`; keeps an incomplete one.
  /// @return false if the stream is invalid
  template <class Use>
  bool feed(std::span<const std::byte> bytes, Use&& use) noexcept {
    return split(bytes, [&](const Record& record) {
      SpacenavEvent event;
      if (!parse(record, event)) return false;
      use(static_cast<const SpacenavEvent&>(event));
      return true;
    });
  }

 private:
  static bool parse(const Record& record, SpacenavEvent& event) noexcept {
    std::array<std::int32_t, 8> words{};
    std::memcpy(words.data(), record.data(), record.size());
    switch (words[0]) {
      case 0:
        event.kind = SpacenavEvent::Kind::motion;
        std::copy_n(words.begin() + 1, 6, event.axes.begin());
        return std::all_of(event.axes.begin(), event.axes.end(), [](std::int32_t counts) {
          return counts >= -most_counts && counts <= most_counts;
        });
      case 1:
      case 2:
        event.kind = words[0] == 1 ? SpacenavEvent::Kind::press : SpacenavEvent::Kind::release;
        event.button = words[1];
        return event.button >= 0 && event.button < most_buttons;
      default:
        event.kind = SpacenavEvent::Kind::other;
        return words[0] >= 3 && words[0] <= 6;
    }
  }
};

}  // namespace repel::devices
