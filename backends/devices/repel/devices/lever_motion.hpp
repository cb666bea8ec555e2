/// @file
/// Angle and rate of a lever from the counts of its axis.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include <repel/devices/clock.hpp>

namespace repel::devices {

/// What the kernel says of the axis, and what it is in angles.
struct LeverScale {
  std::int32_t low = -32768;   ///< [counts] at one end
  std::int32_t high = 32767;   ///< [counts] at the other; > low
  std::int32_t fuzz = 0;       ///< [counts] of change that the kernel keeps to itself
  double full_range = 1.0;     ///< [rad] from low to high
  double time_constant = 0.0;  ///< [s] of the low pass on the rate; 0 for none
  double max_rate = 20.0;      ///< [rad/s] anything faster is cut to it
};

/// The kernel sends an axis only when it has changed. So the rate is the difference of two changes
/// over their time stamps, through a first-order low pass; and the longer nothing comes, the slower
/// the lever must be: had it turned by a count, we would know. The rate is at most one count over
/// the time since the last change, after a grace of `report_interval` in which no device need talk.
class LeverMotion {
 public:
  static constexpr double report_interval = 0.02;  ///< [s] longer than that of usual devices

  explicit LeverMotion(const LeverScale& scale) noexcept : scale_(scale) {}

  /// The lever is here now, and nobody knows how it came: at rest.
  void place(std::int32_t counts, std::chrono::nanoseconds time) noexcept {
    angle_ = from_ = angle_of(counts);
    since_ = changed_at_ = time;
    rate_ = 0.0;
  }

  /// The kernel reports the axis with its time. A time that does not run on is no time to divide
  /// by: the change counts at the next.
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

  /// [rad/s] at the time `now`, by the clock of the stamps; at most `max_rate`, 0 in the long run
  [[nodiscard]] double rate(std::chrono::nanoseconds now) const noexcept {
    const double quiet = in_seconds(now - changed_at_) - report_interval;
    if (!(quiet > 0.0)) return rate_;
    const double most = count() * std::max(1, scale_.fuzz) / quiet;
    const double rate = std::clamp(rate_, -most, most);
    return rate < least && rate > -least ? 0.0 : rate;
  }

 private:
  static constexpr double shortest = 1e-4;  // [s]
  static constexpr double least = 1e-3;     // [rad/s] of a lever that has long stood still

  /// [rad]
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
