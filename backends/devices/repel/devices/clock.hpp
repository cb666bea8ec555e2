// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The clock of the input devices.
#pragma once

#include <chrono>

namespace repel::devices {

/// A monotonic clock. Tests replace `steady_now` by their own.
using Clock = std::chrono::nanoseconds (*)() noexcept;

/// The steady clock: CLOCK_MONOTONIC on Linux, also used by the kernel to time-stamp events.
[[nodiscard]] inline std::chrono::nanoseconds steady_now() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
}

/// [s]
[[nodiscard]] inline double in_seconds(std::chrono::nanoseconds time) noexcept {
  return std::chrono::duration<double>(time).count();
}

}  // namespace repel::devices
