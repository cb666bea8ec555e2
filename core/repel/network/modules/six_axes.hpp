// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIX AXES: a simulated force-reflecting master of six degrees of freedom, with the hand that
/// holds it.
#pragma once

#include <array>
#include <cstddef>

#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/held_axis.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The handle and the hand that holds it. The first numbers are for motion along the axes, those
/// with `angular` for motion about them.
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
};

/// A one-port of the tool space: wrench in, twist out; a HeldAxis along and about each of the world
/// axes at the origin of the tool. Its hand moves at the rates of HandInput::ball. Not in the
/// paper, whose spaceball feels nothing.
class SixAxes {
 public:
  static constexpr Traits traits{.right = Space::tool};  ///< a tool on the right

  /// @throws SetupError for a number out of range
  explicit SixAxes(const SixAxesOptions& options = {}) : options_(options) {
    checked("mass", options.mass, 1e-6, 1e3, "kg");
    checked("inertia", options.inertia, 1e-9, 1e3, "kg m^2");
    checked("friction", options.friction, 0.0, 1e4, "N s/m");
    checked("angular friction", options.angular_friction, 0.0, 1e3, "N m s/rad");
    checked("hand stiffness", options.hand_stiffness, 0.0, 1e6, "N/m");
    checked("hand damping", options.hand_damping, 0.0, 1e5, "N s/m");
    checked("angular hand stiffness", options.angular_hand_stiffness, 0.0, 1e5, "N m/rad");
    checked("angular hand damping", options.angular_hand_damping, 0.0, 1e4, "N m s/rad");
    checked("force limit", options.force_limit, 0.0, 1e5, "N");
    checked("torque limit", options.torque_limit, 0.0, 1e4, "N m");
    checked("motion scale", options.motion_scale, 1e-3, 1e3, "");
  }

  /// At rest at zero. @param period [s] of the network.
  void prepare(double period) {
    detail::checked_period(period);
    const HeldAxisGains along{options_.mass, options_.friction, options_.hand_stiffness,
                              options_.hand_damping, options_.force_limit};
    const HeldAxisGains about{options_.inertia, options_.angular_friction,
                              options_.angular_hand_stiffness, options_.angular_hand_damping,
                              options_.torque_limit};
    for (std::size_t i = 0; i < 6; ++i) axes_[i] = HeldAxis(i < 3 ? along : about, period);
    scale_.prepare(period);
    show_resistance();
  }

  /// Moves the hand by the rates of HandInput::ball, and follows its scale.
  void read(const Signals& signals) noexcept {
    const HandInput& input = signals.of(options_.hand);
    scale_.step(input.scale);
    show_resistance();
    const Vec<any_size> hand = to_vec(input.ball);
    for (std::size_t i = 0; i < 6; ++i) {
      axes_[i].move(hand.coeff(static_cast<Eigen::Index>(i)), signals.at_rest);
    }
  }

  /// [N s/m, N m s/rad] of its port, diagonal.
  [[nodiscard]] const Mat<6>& resistance() const noexcept { return resistance_; }
  // Seen from the tool, with v = s v_hand and f_hand = s f, waves are 1 / s of those at the hand.
  /// The wave of this tick.
  [[nodiscard]] Vec<6> reflected() const noexcept {
    return all([&](const HeldAxis& axis) { return axis.reflected() / scale(); });
  }
  /// Takes the wave that arrives; every axis advances.
  void incident(const Vec<6>& wave) noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
      axes_[i].incident(scale() * wave.coeff(static_cast<Eigen::Index>(i)));
    }
  }

  [[nodiscard]] Hand hand() const noexcept { return options_.hand; }  ///< that holds it
  /// Tool motion per hand motion, in this tick.
  [[nodiscard]] double scale() const noexcept { return options_.motion_scale * scale_.value(); }
  /// [m, rad] of the hand, since the start.
  [[nodiscard]] Vec<6> position() const noexcept {
    return all([](const HeldAxis& axis) { return axis.position(); });
  }
  [[nodiscard]] Vec<6> rate() const noexcept {  ///< [m/s, rad/s] of the hand
    return all([](const HeldAxis& axis) { return axis.rate(); });
  }
  [[nodiscard]] Vec<6> felt() const noexcept {  ///< [N, N m] of the motors
    return all([](const HeldAxis& axis) { return axis.felt(); });
  }
  /// [N, N m] of the grip on the hand: what a device is to show whose motion HandInput::ball is.
  [[nodiscard]] Vec<6> grip() const noexcept {
    return all([](const HeldAxis& axis) { return axis.grip(); });
  }
  /// [N s/m, N m s/rad] HeldAxis::device_damping of every axis. @param late [s]
  [[nodiscard]] Vec<6> device_damping(double late) const noexcept {
    return all([&](const HeldAxis& axis) { return axis.device_damping(late); });
  }
  /// [N s/m, N m s/rad] HeldAxis::best_grip_damping of every axis.
  [[nodiscard]] Vec<6> best_grip_damping(double late) const noexcept {
    return all([&](const HeldAxis& axis) { return axis.best_grip_damping(late); });
  }
  [[nodiscard]] double supplied() const noexcept {  ///< [W] by the hand
    double sum = 0.0;
    for (const HeldAxis& axis : axes_) sum += axis.supplied();
    return sum;
  }
  /// Some motor was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept {
    bool any = false;
    for (const HeldAxis& axis : axes_) any = any || axis.saturated();
    return any;
  }

 private:
  void show_resistance() noexcept {
    const double s = scale();
    for (std::size_t i = 0; i < 6; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      resistance_.coeffRef(at, at) = axes_[i].resistance() / (s * s);
    }
  }
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
