// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIX AXES: a simulated force-reflecting master of six degrees of freedom, with the operator's
/// hand.
#pragma once

#include <array>
#include <cstddef>

#include <repel/base/field.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/held_axis.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The handle and the operator's hand. The first numbers are for motion along the axes, those with
/// `angular` for motion about them.
struct SixAxesOptions {
  double mass = 0.3;                    ///< [kg] of the handle
  double inertia = 1e-3;                ///< [kg m^2]
  double friction = 1.0;                ///< [N s/m]
  double angular_friction = 0.01;       ///< [N m s/rad]
  double hand_stiffness = 300.0;        ///< [N/m] of the hand's grip
  double hand_damping = 10.0;           ///< [N s/m]
  double angular_hand_stiffness = 3.0;  ///< [N m/rad]
  double angular_hand_damping = 0.1;    ///< [N m s/rad]
  double force_limit = 30.0;            ///< [N] of the motors, along each axis
  double torque_limit = 2.0;            ///< [N m] about each axis
  /// Tool motion per hand motion. The hand feels the wrench at the tool times the same number, so
  /// that no power is lost. Multiplied by HandInput::scale (ChangingScale).
  double motion_scale = 1.0;
  Hand hand = Hand::first;  ///< that holds it

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"mass", "kg", 1e-6, 1e3}, o.mass);
    visit(Field{"inertia", "kg m^2", 1e-9, 1e3}, o.inertia);
    visit(Field{"friction", "N s/m", 0.0, 1e4}, o.friction);
    visit(Field{"angular_friction", "N m s/rad", 0.0, 1e3}, o.angular_friction);
    visit(Field{"hand_stiffness", "N/m", 0.0, 1e6}, o.hand_stiffness);
    visit(Field{"hand_damping", "N s/m", 0.0, 1e5}, o.hand_damping);
    visit(Field{"angular_hand_stiffness", "N m/rad", 0.0, 1e5}, o.angular_hand_stiffness);
    visit(Field{"angular_hand_damping", "N m s/rad", 0.0, 1e4}, o.angular_hand_damping);
    visit(Field{"force_limit", "N", 0.0, 1e5}, o.force_limit);
    visit(Field{"torque_limit", "N m", 0.0, 1e4}, o.torque_limit);
    visit(Field{"motion_scale", "", 1e-3, 1e3}, o.motion_scale);
    visit(Choice{"hand", {"first", "second"}}, o.hand);
  }
};

/// A one-port of the tool space: wrench in, twist out; a HeldAxis along and about each of the world
/// axes at the origin of the tool. Its hand moves at the rates of HandInput::ball. Not in the
/// paper, whose spaceball feels nothing.
class SixAxes {
 public:
  static constexpr Traits traits{.right = Space::tool};  ///< a tool on the right

  /// @throws SetupError for a number out of range
  explicit SixAxes(const SixAxesOptions& options = {});

  /// At rest at zero. @param period [s] of the network.
  void prepare(double period);

  /// Moves the hand by the rates of HandInput::ball, and follows its scale.
  void read(const Signals& signals) noexcept;

  /// [N s/m, N m s/rad] of its port, diagonal.
  [[nodiscard]] const Mat<6>& resistance() const noexcept { return resistance_; }
  // Seen from the tool, with v = s v_hand and f_hand = s f, waves are 1 / s of those at the hand.
  /// The wave of this tick.
  [[nodiscard]] Vec<6> reflected() const noexcept;
  /// Takes the wave that arrives; every axis advances.
  void incident(const Vec<6>& wave) noexcept;

  [[nodiscard]] Hand hand() const noexcept { return options_.hand; }  ///< that holds it
  /// Tool motion per hand motion, in this tick.
  [[nodiscard]] double scale() const noexcept { return options_.motion_scale * scale_.value(); }
  /// [m, rad] of the hand, since the start.
  [[nodiscard]] Vec<6> position() const noexcept;
  /// [m/s, rad/s] of the hand.
  [[nodiscard]] Vec<6> rate() const noexcept;
  /// [N, N m] of the motors.
  [[nodiscard]] Vec<6> felt() const noexcept;
  /// [N, N m] of the grip on the hand: the force for a device with HandInput::ball as its motion.
  [[nodiscard]] Vec<6> grip() const noexcept;
  /// [N s/m, N m s/rad] HeldAxis::device_damping of every axis. @param late [s]
  [[nodiscard]] Vec<6> device_damping(double late) const noexcept;
  /// [N s/m, N m s/rad] HeldAxis::best_grip_damping of every axis.
  [[nodiscard]] Vec<6> best_grip_damping(double late) const noexcept;
  /// [W] by the hand.
  [[nodiscard]] double supplied() const noexcept;
  /// Some motor was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept;

 private:
  void show_resistance() noexcept;
  template <class Of>
  [[nodiscard]] Vec<6> all(Of&& of) const noexcept {
    Vec<6> values;
    for (std::size_t i = 0; i < 6; ++i)
      values.coeffRef(static_cast<Eigen::Index>(i)) = of(axes_[i]);
    return values;
  }

  SixAxesOptions options_;
  std::array<HeldAxis, 6> axes_;
  ChangingScale scale_;
  Mat<6> resistance_ = Mat<6>::Zero();
};

}  // namespace repel::network
