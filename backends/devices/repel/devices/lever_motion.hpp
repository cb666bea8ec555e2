// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Estimates angle and rate of a lever from the counts of its axis.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include <repel/devices/clock.hpp>

namespace repel::devices {

/// The range of the axis that the kernel reports, and its meaning as an angle.
struct LeverScale {
  std::int32_t low = -32768;   ///< [counts] at one end
  std::int32_t high = 32767;   ///< [counts] at the other; > low
  std::int32_t fuzz = 0;       ///< [counts] changes below this are filtered by the kernel
  double full_range = 1.0;     ///< [rad] from low to high
  double time_constant = 0.0;  ///< [s] of the low-pass filter on the rate; 0: none
  double max_rate = 20.0;      ///< [rad/s] saturation of the rate
};

/// The kernel reports an axis only when it has changed. The rate is the difference of two changes
/// over that of their time stamps, through a first-order low-pass filter. While nothing is
/// reported, the lever has moved by less than one count, so the rate is bounded by one count over
/// the time since the last change, minus a grace time of `report_interval`.
class LeverMotion {
 public:
  static constexpr double report_interval = 0.02;  ///< [s] above that of common devices

  /// At rest, before the first reading.
  explicit LeverMotion(const LeverScale& scale) noexcept : scale_(scale) {}

  /// Sets the current position when the motion up to it is unknown: rate zero.
  void place(std::int32_t counts, std::chrono::nanoseconds time) noexcept {
    angle_ = from_ = angle_of(counts);
    since_ = changed_at_ = time;
    rate_ = 0.0;
  }

  /// Processes a report of the axis with its time stamp. If the time has not advanced, the change
  /// is evaluated with the next report.
  void move(std::int32_t counts, std::chrono::nanoseconds time) noexcept {
    angle_ = angle_of(counts);
    const double passed = in_seconds(time - since_);
    if (passed < shortest) return;
    const double raw = std::clamp((angle_ - from_) / passed, -scale_.max_rate, scale_.max_rate);
    rate_ += passed / (passed + scale_.time_constant) * (raw - rate_);
    if (angle_ != from_) changed_at_ = time;
    from_ = angle_;
    since_ = time;
  }

  /// [rad] 0 in the middle of the range
  [[nodiscard]] double angle() const noexcept { return angle_; }

  /// [rad/s] at the time `now`, by the clock of the time stamps; at most `max_rate`, decays to 0
  [[nodiscard]] double rate(std::chrono::nanoseconds now) const noexcept {
    const double quiet = in_seconds(now - changed_at_) - report_interval;
    if (!(quiet > 0.0)) return rate_;
    const double most = count() * std::max(1, scale_.fuzz) / quiet;
    const double rate = std::clamp(rate_, -most, most);
    return rate < least && rate > -least ? 0.0 : rate;
  }

 private:
  static constexpr double shortest = 1e-4;  // [s]
  static constexpr double least = 1e-3;     // [rad/s] less counts as zero once the lever is quiet
  [[nodiscard]] double count() const noexcept {
    return scale_.full_range / (static_cast<double>(scale_.high) - scale_.low);
  }
  [[nodiscard]] double angle_of(std::int32_t counts) const noexcept {
    const double inside = std::clamp(counts, scale_.low, scale_.high);
    return count() * (inside - 0.5 * (static_cast<double>(scale_.high) + scale_.low));
  }

  LeverScale scale_;
  double angle_ = 0.0;                      // [rad]
  double from_ = 0.0;                       // [rad] at since_
  double rate_ = 0.0;                       // [rad/s] at since_
  std::chrono::nanoseconds since_{0};       // of the last report
  std::chrono::nanoseconds changed_at_{0};  // of the last report with another angle
};

}  // namespace repel::devices
