// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parses the events of a Linux input device from the bytes of /dev/input/eventN. Does no I/O.
#pragma once

#include <linux/input.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <repel/devices/records.hpp>

namespace repel::devices {

/// One event of the kernel, with the numbers of linux/input.h.
struct EvdevEvent {
  std::chrono::nanoseconds time{0};  ///< by the clock that was selected for the device
  /// EV_ABS, EV_KEY, ...
  std::uint16_t type = 0;
  std::uint16_t code = 0;  ///< of the axis or key
  std::int32_t value = 0;  ///< position of an axis; 1 or 0 of a key
};

/// Splits the bytes into `input_event`s. An impossible time stamp invalidates the stream until
/// `reset`.
class EvdevParser : public detail::Records<sizeof(input_event)> {
 public:
  /// Passes every complete event to `use(const EvdevEvent&)`; keeps an incomplete one.
  /// @return false if the stream is invalid
  template <class Use>
  bool feed(std::span<const std::byte> bytes, Use&& use) noexcept {
    return split(bytes, [&](const Record& record) {
      input_event raw{};
      std::memcpy(&raw, record.data(), record.size());
      const auto seconds = static_cast<std::int64_t>(raw.input_event_sec);
      const auto microseconds = static_cast<std::int64_t>(raw.input_event_usec);
      if (seconds < 0 || seconds > most_seconds) return false;
      if (microseconds < 0 || microseconds >= 1000000) return false;
      const auto time = std::chrono::seconds(seconds) + std::chrono::microseconds(microseconds);
      use(EvdevEvent{time, raw.type, raw.code, raw.value});
      return true;
    });
  }

 private:
  static constexpr std::int64_t most_seconds = 1LL << 32;  // nanoseconds still fit
};

}  // namespace repel::devices
