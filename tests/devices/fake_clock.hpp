// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A clock that the test advances manually.
#pragma once

#include <atomic>
#include <chrono>

namespace repel::devices {

/// Starts at one day, so that no device confuses it with the epoch.
struct FakeClock {
  static inline std::atomic<std::chrono::nanoseconds::rep> time{86400LL * 1000000000};

  static std::chrono::nanoseconds now() noexcept { return std::chrono::nanoseconds(time.load()); }
  static void pass(double seconds) {
    time += static_cast<std::chrono::nanoseconds::rep>(seconds * 1e9);
  }
};

}  // namespace repel::devices
