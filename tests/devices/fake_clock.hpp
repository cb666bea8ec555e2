/// @file
/// A clock that a test turns by hand.
#pragma once

#include <atomic>
#include <chrono>

namespace repel::devices {

/// Starts at a day, so that no device takes it for the beginning of time.
struct FakeClock {
  static inline std::atomic<std::chrono::nanoseconds::rep> time{86400LL * 1000000000};

  static std::chrono::nanoseconds now() noexcept { return std::chrono::nanoseconds(time.load()); }
  static void pass(double seconds) {
    time += static_cast<std::chrono::nanoseconds::rep>(seconds * 1e9);
  }
};

}  // namespace repel::devices
