// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The rates of a hand, from its measured pose.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/devices/master_device.hpp>

namespace repel::devices {

/// How readings are followed.
struct HandFollowerOptions {
  double time = 0.01;               ///< [s] to catch up with the measured pose
  double most_rate = 2.0;           ///< [m/s] of the resulting rates, in length
  double most_angular_rate = 10.0;  ///< [rad/s]
};

/// Turns the readings of a device into rates with its pose as their sum, so the integral in a
/// network never drifts from it. They are the measured rate, plus the measured pose less the sum of
/// all rates, over `time`. With `time` of one period and no measured rate this is the difference of
/// two poses.
///
/// It begins at the pose of the first enabled reading, so a clutch, a fault or a reconnected device
/// never moves the tool. Motion beyond the limit is given up, not caught up with later. Does not
/// allocate or block: for the tick.
class HandFollower {
 public:
  /// @throws SetupError for a number out of range
  explicit HandFollower(const HandFollowerOptions& options = {}) : options_(options) {
    checked("time of the follower", options.time, 1e-4, 1.0, "s");
    checked("largest rate of the hand", options.most_rate, 1e-3, 20.0, "m/s");
    checked("largest angular rate of the hand", options.most_angular_rate, 1e-3, 200.0, "rad/s");
  }

  /// The rates of the hand in the next period, in W. Those of a device without a pose pass.
  /// @param period [s] above zero
  [[nodiscard]] Twist step(const Measured& m, double period) noexcept {
    if (m.operating_state != OperatingState::enabled || !m.has_position) {
      rest();
      return m.measured_cv;
    }
    const double share = 1.0 / std::max(options_.time, period);
    Twist rates = m.measured_cv;
    if (!follows_) p_ = m.position_W;
    rates.linear += share * (m.position_W - p_);
    if (limit(rates.linear, options_.most_rate)) {
      p_ = m.position_W;
    } else {
      p_ += period * rates.linear;
    }
    follows_ = true;
    if (!m.has_orientation) {
      turns_ = false;
      return rates;
    }
    if (!turns_) R_ = m.R_WH;
    rates.angular += share * rotation(m.R_WH * R_.conjugate());
    if (limit(rates.angular, options_.most_angular_rate)) {
      R_ = m.R_WH;
    } else {
      R_ = turned(R_, period * rates.angular);
    }
    turns_ = true;
    return rates;
  }

  /// Begins anew at the next enabled reading.
  void rest() noexcept { follows_ = turns_ = false; }

 private:
  /// True where it was longer.
  static bool limit(Vec3& v, double most) noexcept {
    const double length = v.norm();
    if (!(length > most)) return false;
    v *= most / length;
    return true;
  }
  /// [rad] the rotation vector, of at most half a turn.
  [[nodiscard]] static Vec3 rotation(const Eigen::Quaterniond& q) noexcept {
    const double sine = q.vec().norm();
    if (sine < 1e-12) return Vec3::Zero();
    const double angle = 2.0 * std::atan2(sine, std::abs(q.w()));
    return std::copysign(angle / sine, q.w()) * q.vec();
  }
  [[nodiscard]] static Eigen::Quaterniond turned(const Eigen::Quaterniond& R,
                                                 const Vec3& by) noexcept {
    const double angle = by.norm();
    if (angle < 1e-12) return R;
    const Eigen::Quaterniond step(Eigen::AngleAxisd(angle, by / angle));
    return (step * R).normalized();
  }

  HandFollowerOptions options_;
  bool follows_ = false, turns_ = false;
  Vec3 p_{0, 0, 0};                                        // sum of the rates
  Eigen::Quaterniond R_ = Eigen::Quaterniond::Identity();  // likewise
};

}  // namespace repel::devices
