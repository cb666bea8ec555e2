/// @file
/// The beat of a loop that runs by the clock.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace repel::host {

/// Wakes the loop at multiples of the period: sleeps, then spins the last stretch, because a sleep
/// alone overshoots and a spin alone is throttled by the scheduler.
class Metronome {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  explicit Metronome(nanoseconds period) : Metronome(period, std::min(longest_spin, period / 4)) {}
  /// @param spin how long before a tick is due the sleep ends; 0: sleeps only
  Metronome(nanoseconds period, nanoseconds spin)
      : period_(period), spin_(spin), due_(now() + period) {}

  /// Returns once the next tick is due, and how late that is. While there is time after the sleep,
  /// `rehearse` is called again and again: it keeps the processor as it should find the tick.
  template <class Rehearse>
  nanoseconds wait(Rehearse&& rehearse) {
    const nanoseconds sleep_until = due_ - spin_;
    if (sleep_until > now()) {
      const timespec until{sleep_until.count() / 1000000000, sleep_until.count() % 1000000000};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
    while (due_ - now() > spin_ / 4) rehearse();
    nanoseconds late = now() - due_;
    while (late.count() < 0) late = now() - due_;
    due_ += period_;
    return late;
  }

  /// After a pause of more than a second, gives up the ticks that were missed; returns how many.
  std::int64_t catch_up() {
    if (now() - due_ < std::chrono::seconds(1)) return 0;
    const std::int64_t lost = (now() - due_) / period_;
    due_ += lost * period_;
    return lost;
  }

 private:
  static constexpr nanoseconds longest_spin{150000};

  static nanoseconds now() {
    return std::chrono::duration_cast<nanoseconds>(
        std::chrono::steady_clock::now().time_since_epoch());
  }

  nanoseconds period_;
  nanoseconds spin_;
  nanoseconds due_;
};

}  // namespace repel::host
