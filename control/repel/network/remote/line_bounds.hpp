// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bounds on the waves received over a line from another program.
#pragma once

#include <limits>

#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/wave_account.hpp>

namespace repel::network {

/// Bounds of the operator's motion and force at the robot, by the master in the hand and the
/// coupling between line and robot. Infinite: not bounded.
struct LineBounds {
  static constexpr double none = std::numeric_limits<double>::infinity();  ///< not bounded

  double speed = none;        ///< [m/s] of the tool
  double turning = none;      ///< [rad/s] of the tool
  double force = none;        ///< [N] on the tool along each axis
  double torque = none;       ///< [N m] about each axis
  double hand_force = none;   ///< [N] of the motors of the master along each axis; [N m] of a lever
  double hand_torque = none;  ///< [N m] about each axis
  double motion_scale = 1.0;  ///< tool motion per hand motion; of a lever [m/rad]
  double force_scale = 1.0;   ///< force at the hand per force at the tool; of a lever [m]
  Hand hand = Hand::first;    ///< that holds the master; HandInput::scale multiplies both scales
};

/// Cuts the waves of a line to its bounds. A wave u, p = 2 sqrt(Z) u, pushes an end moving at v
/// with f = p - Z v. So no sound wave is larger than
///
///     |u| <= (F + Z v) / (2 sqrt(Z))
///
/// with the greatest force F and speed v: sound ends send no larger one. That alone bounds neither
/// force nor speed: a wave for leaning on a wall drives a free tool far too fast. So the end at the
/// robot cuts p to F + Z v along each axis, v its own velocity, and to f + Z v with the greatest
/// speed v, f its own force. Both are of the tick before. A wave is only made smaller: the rest is
/// lost, and the end stays passive.
class WaveLimiter {
 public:
  WaveLimiter() = default;
  /// @param impedance of the line @param space of its port
  WaveLimiter(const LineBounds& bounds, const LineImpedance& impedance, Space space);
  /// @param period [s] of the network
  void prepare(double period) noexcept;

  /// Follows the scale of the hand.
  void read(const Signals& signals) noexcept;
  /// The end was in this state, effort into the line.
  void note(const PortState<any_size>& state) noexcept;

  /// [W] The largest sound wave, squared.
  [[nodiscard]] double most_power() const noexcept { return most_power_; }

  /// Cuts a wave [sqrt(W)] to the largest sound one.
  void cut_to_sound(Vec<any_size>& wave) const noexcept;
  /// Cuts a wave that comes out at the robot [sqrt(W)]. True when it was larger.
  [[nodiscard]] bool cut(Vec<any_size>& wave) const noexcept;

 private:
  /// Entries of the port of one unit.
  struct Group {
    Eigen::Index first = 0, end = 0;
    double Z = 1.0;      ///< [N s/m] or [N m s/rad]
    double force = 0.0;  ///< [N] or [N m] of each entry
    double speed = 0.0;  ///< [m/s] or [rad/s] of all together
    [[nodiscard]] double most_wave() const noexcept;
  };
  static constexpr double most_known = 1e12;  ///< [W] where nothing bounds it

  void reset() noexcept;
  [[nodiscard]] static double length_of(const Vec<any_size>& v, const Group& group) noexcept;
  static void scale(Vec<any_size>& v, const Group& group, double share) noexcept;

  void set_bounds() noexcept;
  void cut_to_force(double& u, const Group& group, Eigen::Index i) const noexcept;
  void cut_to_speed(Vec<any_size>& wave, const Group& group) const noexcept;
  /// [m/s, rad/s] Greatest flow in the direction of a wave.
  [[nodiscard]] double speed_along(const Vec<any_size>& wave, double length,
                                   const Group& group) const noexcept;

  LineBounds bounds_;
  LineImpedance impedance_;
  Space space_ = Space::any;
  ChangingScale scale_;
  Group groups_[2];
  double most_power_ = most_known;
  Jacobian jacobian_;
  Vec<any_size> flow_;  // of the tick before [m/s, rad/s]
  Vec<any_size> push_;  // of the tick before [N, N m] out of the line
};

}  // namespace repel::network
