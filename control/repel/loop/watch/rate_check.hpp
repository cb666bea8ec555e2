// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks that positions and rates of a joint agree.
#pragma once

#include <limits>

#include <repel/loop/options.hpp>

namespace repel {

/// A position follows from the last one and the mean of the rates. The difference is compared with
/// the noise over one reading, about ten, and about a second. The last one also allows a share of
/// the way travelled and the accumulated scatter of the readings. Until it is a fault, the
/// difference counts as an untold rate. Angles; lengths likewise.
class RateCheck {
 public:
  /// @param moved [rad] since the last reading @param last_v [rad/s] told then @param v told now
  /// @param elapsed [s] between both @param is_late readings are missing: the rate may have
  /// differed for a while @param period [s] usual
  /// @return whether both agree
  [[nodiscard]] bool step(double moved, double last_v, double v, double elapsed, bool is_late,
                          const JointWatchOptions& options, double period) noexcept;

  /// [rad/s] Untold rate: of the positions less the rate read, signed; 0 within the noise.
  [[nodiscard]] double untold() const noexcept { return untold_; }
  /// The same, without the last reading.
  [[nodiscard]] double untold_before() const noexcept { return untold_before_; }

  /// Without a past.
  void forget() noexcept;

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  static constexpr double fastest = 1e4;        // [rad/s] no joint is
  static constexpr double memory = 0.9;         // decay per tick of the leaky sums
  static constexpr double long_memory = 1.0;    // [s]
  static constexpr double share_of_way = 0.04;  // by which a scale of positions or rates may be off
  static constexpr double clear = 0.1;          // of the position noise

  // At once only where the positions go on as they did: noise and a slip are jumps.
  void note(double missing, double jump, double bend, double elapsed,
            const JointWatchOptions& options) noexcept;

  double last_moved_ = unknown;                // [rad]
  double drift_ = 0.0;                         // [rad] missing, leaky sum
  double change_ = 0.0;                        // [rad/s] of the rate, leaky sum
  double time_ = 0.0;                          // [s] leaky sum
  double slip_ = 0.0;                          // [rad] missing, over a second
  double way_ = 0.0;                           // [rad] travelled, over a second
  double top_ = 0.0;                           // [rad/s] speed, over a second
  double scatter_ = 0.0, last_missing_ = 0.0;  // [rad^2] of the difference, over a second; [rad]
  double untold_ = 0.0, untold_before_ = 0.0;  // [rad/s]
};

}  // namespace repel
