/// @file
/// TORQUE ARM: a force-reflecting lever of one degree of freedom, simulated, with a hand on it.
#pragma once

#include <algorithm>

namespace repel::network {

/// The lever and the hand that holds it.
struct TorqueArmOptions {
  double inertia = 0.01;         ///< [kg m^2] lever
  double friction = 0.05;        ///< [N m s/rad] of its bearing
  double hand_stiffness = 20.0;  ///< [N m/rad] how firmly the hand leads
  double hand_damping = 0.6;     ///< [N m s/rad]
  double torque_limit = 10.0;    ///< [N m] most the motor can reflect
  double velocity_scale = 0.1;   ///< s_v [m/rad] tool motion per lever motion
  double force_scale = 0.1;      ///< s_f [m] lever torque per tool force; s_f = s_v is lossless
};

/// A one-port: torque in, rate out. The hand follows its own course through a spring and a damper,
/// so a lever that is pushed back lags behind it, and the hand's torque says what is felt.
class TorqueArm {
 public:
  explicit TorqueArm(const TorqueArmOptions& options) noexcept : options_(options) {}

  void reset() noexcept { angle_ = rate_ = hand_angle_ = felt_ = 0.0; }

  /// One period with the hand leading at `hand_rate` [rad/s] against `torque` [N m] from the
  /// motor. Returns the rate of the lever [rad/s]. Implicit Euler: spring and dampers act on the
  /// new angle and rate, so that no gain makes them unstable.
  double step(double hand_rate, double torque, double period) noexcept {
    torque = std::clamp(torque, -options_.torque_limit, options_.torque_limit);
    hand_angle_ += period * hand_rate;
    const double spring = options_.hand_stiffness * (hand_angle_ - angle_);
    const double push = spring + options_.hand_damping * hand_rate + torque;
    const double drag =
        options_.friction + options_.hand_damping + period * options_.hand_stiffness;
    rate_ = (rate_ + period * push / options_.inertia) / (1.0 + period * drag / options_.inertia);
    angle_ += period * rate_;
    felt_ = torque;
    return rate_;
  }

  [[nodiscard]] double angle() const noexcept { return angle_; }  ///< [rad]
  [[nodiscard]] double rate() const noexcept { return rate_; }    ///< [rad/s]
  [[nodiscard]] double felt() const noexcept { return felt_; }    ///< [N m] reflected last period

 private:
  TorqueArmOptions options_;
  double angle_ = 0.0;
  double rate_ = 0.0;
  double hand_angle_ = 0.0;
  double felt_ = 0.0;
};

}  // namespace repel::network
