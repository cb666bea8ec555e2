// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Waits for the start of the next tick: by the clock, at once, or as the user controls it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include <repel/host/metronome.hpp>
#include <repel/runs/operator/controls.hpp>

namespace repel::runs {

/// Timing of the ticks.
enum class Pacing {
  by_the_clock,  ///< each when it is due, in real time
  at_once,       ///< as fast as possible
  shown,         ///< a replay in the live view: in real time, scaled by the speed of the controls
};

class Pace {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// @param controls null: no pause, step or seek
  Pace(Pacing pacing, nanoseconds period, Controls* controls)
      : pacing_(pacing), period_(period), controls_(controls), metronome_(period) {}

  /// Returns when the tick of scene time `time` [s] is to start, and by how much it is late by the
  /// clock.
  /// @param on_pause called whenever a pause begins
  template <class Rehearse, class OnPause = void (*)()>
  nanoseconds wait(
      double time, const std::atomic<bool>& stop, Rehearse&& rehearse, OnPause&& on_pause = [] {}) {
    has_arrived_ = false;
    if (controls_ != nullptr && pause(stop, on_pause)) return nanoseconds(0);
    if (pacing_ == Pacing::by_the_clock) return metronome_.wait(rehearse);
    if (pacing_ == Pacing::shown) linger(time, stop);
    return nanoseconds(0);
  }

  /// Before a late tick: skips the missed ticks if the next one is overdue by 50 ms or more, and
  /// returns how many. If less overdue, they are run back to back. The arm keeps moving in skipped
  /// ticks. In a pause none is missed, as single steps are due when they are asked for.
  std::int64_t catch_up() {
    constexpr std::chrono::milliseconds patience(50);
    return pacing_ == Pacing::by_the_clock && !held_ ? metronome_.catch_up(patience) : 0;
  }

  /// Total time for which the user has paused the run; does not count as time of the loop.
  [[nodiscard]] nanoseconds paused_for() const { return paused_for_; }

  /// The user has paused the run before the last tick waited for, or runs it as a single step.
  [[nodiscard]] bool was_paused() const { return was_paused_; }

  /// The run must start over: on a restart, or on a seek to before `time` [s], that of the next
  /// tick.
  [[nodiscard]] bool begins_anew(double time) const {
    if (controls_ == nullptr) return false;
    const double seek = controls_->seek;
    return controls_->restart || (seek >= 0.0 && time - seek >= in_seconds(period_));
  }
  /// The last tick waited for is the target of a seek.
  [[nodiscard]] bool has_arrived() const { return has_arrived_; }

  /// At the end of a replay in the live view: returns on a restart, a seek or `stop`.
  void rest(const std::atomic<bool>& stop) const {
    while (controls_ != nullptr && !stop && !controls_->restart && controls_->seek < 0.0) nap();
  }

 private:
  static constexpr double rounding = 1e-9;  ///< [s]

  static double in_seconds(nanoseconds time) { return 1e-9 * static_cast<double>(time.count()); }
  static void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

  /// Waits while paused. True if a single step is to be run.
  template <class OnPause>
  bool pause(const std::atomic<bool>& stop, OnPause&& on_pause) {
    bool is_shown = false;
    const nanoseconds begin = host::steady_now();
    const bool is_step = sit_out(stop, on_pause, is_shown);
    if (is_shown) paused_for_ += host::steady_now() - begin;
    was_paused_ = is_shown || is_step;
    if (is_step) return true;
    if (held_) {
      metronome_ = host::Metronome(period_);
      base_ = {};
    }
    held_ = false;
    return false;
  }

  /// Returns false when the pause is over, true when a single step is to be run during it.
  template <class OnPause>
  bool sit_out(const std::atomic<bool>& stop, OnPause&& on_pause, bool& is_shown) {
    while (controls_->paused && !stop && !controls_->restart && controls_->seek < 0.0) {
      held_ = true;
      // The other thread may reset `steps` at the same time.
      std::int64_t steps = controls_->steps;
      if (steps > 0) {
        if (!controls_->steps.compare_exchange_strong(steps, steps - 1)) continue;
        return true;
      }
      if (!is_shown) on_pause();
      is_shown = true;
      nap();
    }
    return false;
  }

  void linger(double time, const std::atomic<bool>& stop) {
    const double seek = controls_->seek;
    if (seek >= 0.0) {
      const double ahead = time - seek;
      if (ahead < -rounding || begins_anew(time)) return;  // not reached yet, or already past
      controls_->seek = -1.0;
      has_arrived_ = true;
      base_ = {};
    }
    const double speed = controls_->speed;
    const auto now = std::chrono::steady_clock::now();
    if (base_ == std::chrono::steady_clock::time_point() || speed != speed_) {
      base_ = now;
      base_time_ = time;
      speed_ = speed;
    }
    const auto due = base_ + std::chrono::duration_cast<nanoseconds>(
                                 std::chrono::duration<double>((time - base_time_) / speed_));
    while (std::chrono::steady_clock::now() < due && !stop && controls_->seek < 0.0 &&
           !controls_->paused && controls_->speed == speed_) {
      std::this_thread::sleep_until(
          std::min(due, std::chrono::steady_clock::now() + std::chrono::milliseconds(5)));
    }
  }

  Pacing pacing_;
  nanoseconds period_;
  Controls* controls_;
  host::Metronome metronome_;
  std::chrono::steady_clock::time_point base_;  ///< replay: clock time of `base_time_`
  double base_time_ = 0.0;                      ///< [s]
  double speed_ = 1.0;
  nanoseconds paused_for_{0};
  bool was_paused_ = false;
  bool held_ = false;  ///< ticks were missed during a pause: the metronome must restart
  bool has_arrived_ = false;
};

}  // namespace repel::runs
