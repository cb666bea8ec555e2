/// @file
/// The beat of a loop that runs by the clock.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

namespace repel::host {

/// The time of the steady clock, which no one sets.
[[nodiscard]] inline std::chrono::nanoseconds steady_now() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
}

/// When ticks are due: at a first time of the steady clock and once a period from there.
struct Beat {
  using nanoseconds = std::chrono::nanoseconds;

  nanoseconds first{0};
  nanoseconds period{1};
  std::int64_t ticks = std::numeric_limits<std::int64_t>::max();

  /// How many ticks are due before `time`.
  [[nodiscard]] std::int64_t due_before(nanoseconds time) const noexcept {
    if (time <= first) return 0;
    return std::min(ticks, (time - first - nanoseconds(1)) / period + 1);
  }
};

/// Wakes the loop at every beat: sleeps, then spins the last stretch, because a sleep alone
/// overshoots and a spin alone is throttled by the scheduler.
class Metronome {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// The first tick is due a period from now.
  explicit Metronome(nanoseconds period)
      : Metronome(Beat{steady_now() + period, period}, longest_spin) {}
  /// @param spin how long before a tick is due the sleep ends, at most a quarter of the period;
  ///   0: sleeps only
  Metronome(const Beat& beat, nanoseconds spin)
      : period_(beat.period), spin_(std::min(spin, beat.period / 4)), due_(beat.first) {}

  static constexpr nanoseconds longest_spin{150000};

  /// Returns once the next tick is due, and how late that is. While there is time after the sleep,
  /// `rehearse` is called again and again: it keeps the processor as it should find the tick.
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

  /// Gives up the ticks that were missed if the next is overdue by `patience` or more; returns how
  /// many. With less they are made up for, one right after the other.
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
