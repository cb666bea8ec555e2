// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// TORQUE ARM: a simulated force-reflecting lever of one degree of freedom, with the hand that
/// holds it.
#pragma once

#include <repel/base/field.hpp>
#include <repel/network/elements/held_axis.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The lever and the hand that holds it.
struct TorqueArmOptions {
  double inertia = 0.01;         ///< [kg m^2] lever
  double friction = 0.05;        ///< [N m s/rad] of its bearing
  double hand_stiffness = 20.0;  ///< [N m/rad] of the hand's grip
  double hand_damping = 0.6;     ///< [N m s/rad]
  double torque_limit = 10.0;    ///< [N m] limit of the motor
  Hand hand = Hand::first;       ///< that holds it

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"inertia", "kg m^2", 1e-6, 1e3}, o.inertia);
    visit(Field{"friction", "N m s/rad", 0.0, 1e3}, o.friction);
    visit(Field{"hand_stiffness", "N m/rad", 0.0, 1e5}, o.hand_stiffness);
    visit(Field{"hand_damping", "N m s/rad", 0.0, 1e4}, o.hand_damping);
    visit(Field{"torque_limit", "N m", 0.0, 1e4}, o.torque_limit);
    visit(Choice{"hand", {"first", "second"}}, o.hand);
  }
};

/// A one-port: torque in, rate out; a HeldAxis of the lever space.
class TorqueArm {
 public:
  static constexpr Traits traits{.right = Space::lever};  ///< a lever on the right

  /// @throws SetupError for a number out of range
  explicit TorqueArm(const TorqueArmOptions& options = {});

  /// At rest at zero. @param period [s] of the network.
  void prepare(double period);

  /// Moves the hand by HandInput::lever_rate.
  void read(const Signals& signals) noexcept;

  /// [N m s/rad] of its port.
  [[nodiscard]] const Mat<1>& resistance() const noexcept { return resistance_; }
  /// The wave of this tick.
  [[nodiscard]] Vec<1> reflected() const noexcept { return Vec<1>(axis_.reflected()); }
  /// Takes the wave that arrives; the lever advances.
  void incident(const Vec<1>& wave) noexcept { axis_.incident(wave(0)); }

  [[nodiscard]] double angle() const noexcept { return axis_.position(); }  ///< [rad]
  [[nodiscard]] double rate() const noexcept { return axis_.rate(); }       ///< [rad/s]
  [[nodiscard]] Hand hand() const noexcept { return options_.hand; }        ///< that holds it
  [[nodiscard]] double felt() const noexcept { return axis_.felt(); }       ///< [N m] of the motor
  [[nodiscard]] double supplied() const noexcept { return axis_.supplied(); }  ///< [W] by the hand
  /// The motor was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept { return axis_.saturated(); }

 private:
  TorqueArmOptions options_;
  HeldAxis axis_;
  Mat<1> resistance_ = Mat<1>::Zero();
};

}  // namespace repel::network
