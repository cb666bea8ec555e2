/// @file
/// Between two ticks: waits until the next is due, or until those at the controls want it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "controls.hpp"
#include "metronome.hpp"

namespace repel::teleop {

/// How ticks follow each other.
enum class Beating {
  by_the_clock,  ///< each when it is due, the metronome's business
  at_once,       ///< as fast as it goes
  shown,         ///< a replay that is looked at: by the clock, at the speed of the controls
};

class Pace {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// @param controls null: nobody pauses, steps or seeks
  Pace(Beating beating, nanoseconds period, Controls* controls)
      : beating_(beating), period_(period), controls_(controls), metronome_(period) {}

  /// Returns when the tick of that scene time [s] is to begin: how late it is by the clock.
  /// @param on_pause called whenever a pause begins
  template <class Rehearse, class OnPause = void (*)()>
  nanoseconds wait(
      double time, const std::atomic<bool>& stop, Rehearse&& rehearse, OnPause&& on_pause = [] {}) {
    has_arrived_ = false;
    if (controls_ != nullptr && pause(stop, on_pause)) return nanoseconds(0);
    if (beating_ == Beating::by_the_clock) return metronome_.wait(rehearse);
    if (beating_ == Beating::shown) linger(time, stop);
    return nanoseconds(0);
  }

  /// Before a tick that comes late: gives up those that were due more than `patience` ago; an arm
  /// went on without them. Returns how many. What is late by less is made up for, one tick right
  /// after the other.
  std::int64_t catch_up() {
    constexpr std::chrono::milliseconds patience(50);
    return beating_ == Beating::by_the_clock ? metronome_.catch_up(patience) : 0;
  }

  /// For how long those at the controls have held the run in all: no time of the loop.
  [[nodiscard]] nanoseconds paused_for() const { return paused_for_; }

  /// The ticks made so far are to be forgotten: `time` [s] is the next one's.
  [[nodiscard]] bool begins_anew(double time) const {
    if (controls_ == nullptr) return false;
    const double seek = controls_->seek;
    return controls_->restart || (seek >= 0.0 && time - seek >= in_seconds(period_));
  }
  /// The tick that was waited for last is the one that was to be gone to.
  [[nodiscard]] bool has_arrived() const { return has_arrived_; }

  /// At the end of a replay that is looked at: returns when it is to begin anew, or to end.
  void rest(const std::atomic<bool>& stop) const {
    while (controls_ != nullptr && !stop && !controls_->restart && controls_->seek < 0.0) nap();
  }

 private:
  static constexpr double rounding = 1e-9;  ///< [s]

  static double in_seconds(nanoseconds time) { return 1e-9 * static_cast<double>(time.count()); }
  static void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

  /// While paused. True for a tick that is made all the same.
  template <class OnPause>
  bool pause(const std::atomic<bool>& stop, OnPause&& on_pause) {
    bool is_shown = false;
    const nanoseconds begin = host::steady_now();
    const bool is_step = sit_out(stop, on_pause, is_shown);
    if (is_shown) paused_for_ += host::steady_now() - begin;
    if (is_step) return true;
    if (held_) {
      metronome_ = host::Metronome(period_);
      base_ = {};
    }
    held_ = false;
    return false;
  }

  /// Returns when the pause is over, or with true when a tick is to be made in it.
  template <class OnPause>
  bool sit_out(const std::atomic<bool>& stop, OnPause&& on_pause, bool& is_shown) {
    while (controls_->paused && !stop && !controls_->restart && controls_->seek < 0.0) {
      held_ = true;
      // The other side may take them back at the same time.
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
      if (ahead < -rounding || begins_anew(time)) return;  // on the way, or to be gone back to
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

  Beating beating_;
  nanoseconds period_;
  Controls* controls_;
  host::Metronome metronome_;
  std::chrono::steady_clock::time_point base_;  ///< of a replay: when `base_time_` was
  double base_time_ = 0.0;                      ///< [s]
  double speed_ = 1.0;
  nanoseconds paused_for_{0};
  bool held_ = false;  ///< the clock went on without it
  bool has_arrived_ = false;
};

}  // namespace repel::teleop
