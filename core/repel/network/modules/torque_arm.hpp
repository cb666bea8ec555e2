/// @file
/// TORQUE ARM: a simulated force-reflecting lever of one degree of freedom, with the hand that
/// holds it.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The lever and the hand that holds it.
struct TorqueArmOptions {
  double inertia = 0.01;         ///< [kg m^2] lever
  double friction = 0.05;        ///< [N m s/rad] of its bearing
  double hand_stiffness = 20.0;  ///< [N m/rad] of the hand's grip
  double hand_damping = 0.6;     ///< [N m s/rad]
  double torque_limit = 10.0;    ///< [N m] limit of the motor
};

/// A one-port: torque in, rate out. Inertia, bearing and a hand that follows its own trajectory
/// through a spring and a damper, by the bilinear rule:
///
///     R = 2 I / T + c + (k_h T / 2 + c_h)      b = b_I + b_k - (k_h T / 2 + c_h) v_hand
///
/// with b_I and b_k the waves reflected by inertia and spring. The hand is an energy source; what
/// it supplies is counted separately. The motor never exceeds its limit: the lever takes the wave
/// a' that goes with the torque it can give. Where the hand overpowers the motor, |a'| > |a|: what
/// the lever then takes beyond the power of its port is the work of the hand and counts as
/// supplied.
class TorqueArm {
 public:
  static constexpr Traits traits{.right = Space::lever};

  /// @throws SetupError for a number out of range
  explicit TorqueArm(const TorqueArmOptions& options = {}) : options_(options) {
    checked("inertia", options.inertia, 1e-6, 1e3, "kg m^2");
    checked("friction", options.friction, 0.0, 1e3, "N m s/rad");
    checked("hand stiffness", options.hand_stiffness, 0.0, 1e5, "N m/rad");
    checked("hand damping", options.hand_damping, 0.0, 1e4, "N m s/rad");
    checked("torque limit", options.torque_limit, 0.0, 1e4, "N m");
  }

  void prepare(double period) {
    period_ = detail::checked_period(period);
    mass_resistance_ = 2.0 * options_.inertia / period_;
    spring_resistance_ = 0.5 * options_.hand_stiffness * period_;
    hand_resistance_ = spring_resistance_ + options_.hand_damping;
    resistance_(0) = mass_resistance_ + options_.friction + hand_resistance_;
  }

  void read(const Signals& signals) noexcept {
    hand_rate_ = signals.hand.lever_rate;
    if (signals.at_rest) mass_wave_ = spring_wave_ = rate_ = 0.0;
  }

  [[nodiscard]] const Mat<1>& resistance() const noexcept { return resistance_; }
  [[nodiscard]] Vec<1> reflected() const noexcept {
    return Vec<1>(-mass_wave_ + spring_wave_ - hand_resistance_ * hand_rate_);
  }
  void incident(const Vec<1>& wave) noexcept {
    const double b = reflected()(0);
    double a = wave(0);
    const double limit = options_.torque_limit;
    saturated_ = std::abs(a + b) > 2.0 * limit;
    double overpowered = 0.0;  // [W]
    if (saturated_) {
      const double taken = 2.0 * std::copysign(limit, a + b) - b;
      overpowered = std::max(0.0, (taken * taken - a * a) / (4.0 * resistance_(0)));
      a = taken;
    }
    const double rate = (a - b) / (2.0 * resistance_(0));
    const double relative = rate - hand_rate_;
    supplied_ = overpowered - (spring_wave_ + hand_resistance_ * relative) * hand_rate_;
    mass_wave_ = -mass_wave_ + 2.0 * mass_resistance_ * rate;
    spring_wave_ += 2.0 * spring_resistance_ * relative;
    angle_ += 0.5 * period_ * (rate + rate_);
    rate_ = rate;
    felt_ = 0.5 * (a + b);
  }

  [[nodiscard]] double angle() const noexcept { return angle_; }        ///< [rad]
  [[nodiscard]] double rate() const noexcept { return rate_; }          ///< [rad/s]
  [[nodiscard]] double felt() const noexcept { return felt_; }          ///< [N m] of the motor
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by the hand
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  TorqueArmOptions options_;
  double period_ = 1.0;                                                             // [s]
  double mass_resistance_ = 0.0, spring_resistance_ = 0.0, hand_resistance_ = 0.0;  // [N m s/rad]
  Mat<1> resistance_ = Mat<1>::Zero();
  double mass_wave_ = 0.0, spring_wave_ = 0.0;  // [N m]
  double hand_rate_ = 0.0;                      // [rad/s]
  double angle_ = 0.0, rate_ = 0.0, felt_ = 0.0, supplied_ = 0.0;
  bool saturated_ = false;
};

}  // namespace repel::network
