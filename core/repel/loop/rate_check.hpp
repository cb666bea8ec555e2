// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks that the positions and the rates of a joint tell of the same motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/loop/options.hpp>

namespace repel {

/// A position follows from the last one and the mean of the rates. What is missing is compared with
/// the noise three times: of one reading, of about ten, and of about a second, there with a share
/// of the way travelled and what the scatter of the readings adds up to. Until it is a fault, the
/// difference counts as a rate that was not told. Angles; lengths likewise.
class RateCheck {
 public:
  /// @param moved [rad] since the last reading @param last_v [rad/s] told then @param v told now
  /// @param elapsed [s] between both @param is_late readings are missing: the rate may have been
  /// another for a while @param period [s] usual
  /// @return whether both agree
  [[nodiscard]] bool step(double moved, double last_v, double v, double elapsed, bool is_late,
                          const JointWatchOptions& options, double period) noexcept {
    // Between two readings the rate is assumed to lie between theirs.
    const double step = std::abs(v - last_v);
    const double missing = moved - 0.5 * elapsed * (v + last_v);
    const double speed = std::max(std::abs(v), std::abs(last_v));
    if (!(speed < fastest)) {  // would be remembered for long
      forget();
      return false;
    }
    const double bend = 0.5 * elapsed * step;
    double most = options.position_noise + bend;
    if (is_late) most += elapsed * (speed + options.rate_noise);
    const double off = options.jitter * period * speed;
    untold_before_ = untold_;
    drift_ = memory * drift_ + missing;
    change_ = memory * change_ + step;
    time_ = memory * time_ + elapsed;
    if (is_late) {
      slip_ = way_ = 0.0;
    } else {
      const double kept = 1.0 - std::min(1.0, elapsed / long_memory);
      slip_ = kept * slip_ + missing;
      way_ = kept * way_ + std::max(std::abs(moved), elapsed * speed);
      top_ = std::max(kept * top_, speed);
      const double apart = missing - last_missing_;
      scatter_ = kept * scatter_ + 0.5 * apart * apart;
    }
    last_missing_ = missing;
    note(missing, std::abs(moved - last_moved_), bend, elapsed, options);
    last_moved_ = moved;
    const bool follows = std::abs(missing) <= most + off &&
                         std::abs(drift_) <= 3.0 * most + 2.0 * off + 0.6 * elapsed * change_ &&
                         std::abs(slip_) <= options.position_noise +
                                                2.0 * options.jitter * period * top_ +
                                                share_of_way * way_ + 4.0 * std::sqrt(scatter_);
    if (!follows) forget();  // discards implausible data
    return follows;
  }

  /// [rad/s] By which the positions moved faster than the rates told, signed; 0 within the noise.
  [[nodiscard]] double untold() const noexcept { return untold_; }
  /// The same, without the last reading.
  [[nodiscard]] double untold_before() const noexcept { return untold_before_; }

  /// Without a past.
  void forget() noexcept {
    drift_ = change_ = time_ = slip_ = way_ = top_ = scatter_ = last_missing_ = untold_ = 0.0;
    last_moved_ = unknown;
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  static constexpr double fastest = 1e4;        // [rad/s] no joint is
  static constexpr double memory = 0.9;         // decay per tick of the leaky sums
  static constexpr double long_memory = 1.0;    // [s]
  static constexpr double share_of_way = 0.04;  // by which a scale of positions or rates may be off
  static constexpr double clear = 0.1;          // of the position noise

  // At once only where the positions go on as they did: noise and a slip are jumps.
  void note(double missing, double jump, double bend, double elapsed,
            const JointWatchOptions& options) noexcept {
    const double noise = clear * options.position_noise;
    const auto beyond = [&](double way, double most) { return std::abs(way) > most ? way : 0.0; };
    const double most = 3.0 * noise + bend;
    const double at_once = jump > most ? 0.0 : beyond(missing, most) / elapsed;
    const double lately = beyond(drift_, noise + elapsed * change_) / time_;
    untold_ = std::abs(at_once) > std::abs(lately) ? at_once : lately;
  }

  double last_moved_ = unknown;                // [rad]
  double drift_ = 0.0;                         // [rad] missing, leaky sum
  double change_ = 0.0;                        // [rad/s] of the rate, leaky sum
  double time_ = 0.0;                          // [s] leaky sum
  double slip_ = 0.0;                          // [rad] missing, over a second
  double way_ = 0.0;                           // [rad] travelled, over a second
  double top_ = 0.0;                           // [rad/s] speed, over a second
  double scatter_ = 0.0, last_missing_ = 0.0;  // [rad^2] of what is missing, over a second; [rad]
  double untold_ = 0.0, untold_before_ = 0.0;  // [rad/s]
};

}  // namespace repel
