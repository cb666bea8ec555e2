/// @file
/// Where a device has the time from.
#pragma once

#include <chrono>

namespace repel::devices {

/// The time of a clock that no one sets. A test puts its own in place of `steady_now`.
using Clock = std::chrono::nanoseconds (*)() noexcept;

/// The steady clock: CLOCK_MONOTONIC on Linux, by which the kernel stamps events as well.
[[nodiscard]] inline std::chrono::nanoseconds steady_now() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
}

/// [s]
[[nodiscard]] inline double in_seconds(std::chrono::nanoseconds time) noexcept {
  return std::chrono::duration<double>(time).count();
}

}  // namespace repel::devices
