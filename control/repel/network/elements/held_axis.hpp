// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One axis of a force-reflecting master, with the operator's hand.
#pragma once

namespace repel::network {

/// Gains of a sliding axis [kg, N s/m, N/m, N s/m, N], or of a turning one [kg m^2, N m s/rad,
/// N m/rad, N m s/rad, N m].
struct HeldAxisGains {
  double inertia = 0.0;         ///< of the handle
  double friction = 0.0;        ///< of its bearing
  double hand_stiffness = 0.0;  ///< of the spring between hand and handle
  double hand_damping = 0.0;    ///< of the damper beside that spring
  double limit = 0.0;           ///< of the motor
};

/// Inertia, bearing and a hand that follows its own trajectory through a spring and a damper, by
/// the bilinear rule:
///
///     R = 2 I / T + c + (k_h T / 2 + c_h)      b = b_I + b_k - (k_h T / 2 + c_h) v_hand
///
/// with b_I and b_k the waves reflected by inertia and spring. The hand is an energy source; its
/// supply is counted separately. The motor never exceeds its limit: the axis takes the wave a' of
/// its possible effort. If the hand overpowers the motor, |a'| > |a|: the excess over the power of
/// the port is work of the hand and counts as supplied.
class HeldAxis {
 public:
  HeldAxis() = default;
  /// @param period [s]
  HeldAxis(const HeldAxisGains& gains, double period) noexcept;

  /// The hand moves at this rate [m/s, rad/s] in this tick. @param at_rest lets go of spring and
  /// motion
  void move(double hand_rate, bool at_rest) noexcept;

  /// [N s/m, N m s/rad] of its port.
  [[nodiscard]] double resistance() const noexcept { return resistance_; }
  /// The wave of this tick.
  [[nodiscard]] double reflected() const noexcept;
  /// Takes the wave `a` that arrives, as far as the motor can; advances by one tick.
  void incident(double a) noexcept;

  [[nodiscard]] double position() const noexcept { return position_; }  ///< [m, rad]
  [[nodiscard]] double rate() const noexcept { return rate_; }          ///< [m/s, rad/s]
  [[nodiscard]] double felt() const noexcept { return felt_; }          ///< [N, N m] of the motor
  /// [N, N m] of spring and damper on the hand; times the rate of the hand it is the power into the
  /// hand.
  [[nodiscard]] double grip() const noexcept { return grip_; }
  /// [N s/m, N m s/rad] Damping needed in a real device and its operator's hand, with its measured
  /// motion in `move` and `grip` acting on it, to stay passive behind any passive network. Infinite
  /// for a grip without damping. docs/network/six_axes.md derives it. @param late [s] from a motion
  /// to the force against it, in addition to the sampling
  [[nodiscard]] double device_damping(double late) const noexcept;
  /// [N s/m, N m s/rad] Optimal damping of the grip; `device_damping` is then least, and twice as
  /// much.
  [[nodiscard]] double best_grip_damping(double late) const noexcept;
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by the hand
  /// The motor was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  double period_ = 1.0;  // [s]
  double limit_ = 0.0;
  double mass_resistance_ = 0.0, spring_resistance_ = 0.0, hand_resistance_ = 0.0;
  double resistance_ = 0.0;
  double mass_wave_ = 0.0, spring_wave_ = 0.0;
  double hand_rate_ = 0.0;
  double position_ = 0.0, rate_ = 0.0, felt_ = 0.0, grip_ = 0.0, supplied_ = 0.0;
  bool saturated_ = false;
};

}  // namespace repel::network
