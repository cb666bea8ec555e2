// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Wakes a loop periodically by the steady clock.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

namespace repel::host {

/// The time of the steady (monotonic) clock.
[[nodiscard]] inline std::chrono::nanoseconds steady_now() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
}

/// The schedule of the ticks: the first at a given time of the steady clock, then one per period.
struct Beat {
  using nanoseconds = std::chrono::nanoseconds;

  nanoseconds first{0};
  nanoseconds period{1};
  std::int64_t ticks = std::numeric_limits<std::int64_t>::max();

  /// Number of ticks that are due before `time`.
  [[nodiscard]] std::int64_t due_before(nanoseconds time) const noexcept {
    if (time <= first) return 0;
    return std::min(ticks, (time - first - nanoseconds(1)) / period + 1);
  }
};

/// Wakes the loop at every due time: sleeps first, then spins for the rest. A sleep alone
/// overshoots; a spin alone is throttled by the scheduler.
class Metronome {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// The first tick is due one period from now.
  explicit Metronome(nanoseconds period)
      : Metronome(Beat{steady_now() + period, period}, longest_spin) {}
  /// @param spin the sleep ends this long before a tick is due, at most a quarter of the period; 0:
  ///   sleep only
  Metronome(const Beat& beat, nanoseconds spin)
      : period_(beat.period), spin_(std::min(spin, beat.period / 4)), due_(beat.first) {}

  static constexpr nanoseconds longest_spin{150000};

  /// Returns once the next tick is due, and by how much it is late. After the sleep, `rehearse` is
  /// called repeatedly while time remains, to keep the caches warm for the tick.
  template <class Rehearse>
  nanoseconds wait(Rehearse&& rehearse) {
    const nanoseconds sleep_until = due_ - spin_;
    if (sleep_until > steady_now()) {
      const timespec until{sleep_until.count() / 1000000000, sleep_until.count() % 1000000000};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
    while (due_ - steady_now() > spin_ / 4) rehearse();
    nanoseconds late = steady_now() - due_;
    while (late.count() < 0) late = steady_now() - due_;
    due_ += period_;
    return late;
  }

  /// Skips the missed ticks if the next one is overdue by `patience` or more, and returns their
  /// number. If less overdue, they are run back to back.
  std::int64_t catch_up(nanoseconds patience = std::chrono::seconds(1)) {
    const nanoseconds behind = steady_now() - due_;
    if (behind < std::max(patience, period_)) return 0;
    const std::int64_t lost = behind / period_;
    due_ += lost * period_;
    return lost;
  }

 private:
  nanoseconds period_;
  nanoseconds spin_;
  nanoseconds due_;
};

}  // namespace repel::host
