// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What may come over a line from another program, whoever sends it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/wave_account.hpp>

namespace repel::network {

/// What the operator of a line can ask of the robot: by the master in the hand, and by the coupling
/// between line and robot. Infinite: not bounded.
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

/// Cuts the waves of a line to its bounds. A wave u, p = 2 sqrt(Z) u, pushes an end that moves at v
/// with f = p - Z v. So no sound wave is larger than
///
///     |u| <= (F + Z v) / (2 sqrt(Z))
///
/// with the greatest force F and speed v: both ends send no larger one, and what is larger comes
/// from a program that is false or broken. That alone bounds neither force nor speed: a wave that
/// leans on a wall drives a free tool far too fast. So the end at the robot cuts p to F + Z v along
/// each axis, with the v that it moves at, and to f + Z v with the greatest speed v and the f that
/// it pushes with. Both are of the tick before. A wave is only made smaller: what is cut off is
/// lost, and the end stays passive.
class WaveLimiter {
 public:
  WaveLimiter() = default;
  /// @param impedance of the line @param space of its port
  WaveLimiter(const LineBounds& bounds, const LineImpedance& impedance, Space space)
      : bounds_(bounds), impedance_(impedance), space_(space) {
    reset();
  }
  /// @param period [s] of the network
  void prepare(double period) noexcept {
    scale_.prepare(period);
    set_bounds();
  }

  /// Follows the scale of the hand.
  void read(const Signals& signals) noexcept {
    scale_.step(signals.of(bounds_.hand).scale);
    set_bounds();
    jacobian_ = signals.jacobian;
    if (signals.at_rest) reset();
  }
  /// The end was in this state, effort into the line.
  void note(const PortState<any_size>& state) noexcept {
    flow_ = state.flow;
    push_ = -state.effort;
    double all = 0.0;
    for (Eigen::Index i = 0; i < flow_.size(); ++i) all += flow_.coeff(i) + push_.coeff(i);
    if (all - all != 0.0) reset();
  }

  /// [W] The largest sound wave, squared.
  [[nodiscard]] double most_power() const noexcept { return most_power_; }

  /// Cuts a wave [sqrt(W)] to the largest sound one.
  void cut_to_sound(Vec<any_size>& wave) const noexcept {
    for (const Group& group : groups_) {
      const double most = group.most_wave();
      const double length = length_of(wave, group);
      if (length > most) scale(wave, group, most / length);
    }
  }
  /// Cuts a wave that comes out at the robot [sqrt(W)]. True when it was larger.
  [[nodiscard]] bool cut(Vec<any_size>& wave) const noexcept {
    const Vec<any_size> came = wave;
    cut_to_sound(wave);
    for (const Group& group : groups_) {
      for (Eigen::Index i = group.first; i < group.end; ++i)
        cut_to_force(wave.coeffRef(i), group, i);
      cut_to_speed(wave, group);
    }
    double less = 0.0;
    for (Eigen::Index i = 0; i < wave.size(); ++i) {
      less = std::max(less, std::abs(came.coeff(i) - wave.coeff(i)));
    }
    return less > 1e-9;
  }

 private:
  /// Entries of the port of one unit.
  struct Group {
    Eigen::Index first = 0, end = 0;
    double Z = 1.0;      ///< [N s/m] or [N m s/rad]
    double force = 0.0;  ///< [N] or [N m] of each entry
    double speed = 0.0;  ///< [m/s] or [rad/s] of all together
    [[nodiscard]] double most_wave() const noexcept {
      const double entries = static_cast<double>(end - first);
      return (std::sqrt(entries) * force + Z * speed) / (2.0 * std::sqrt(Z));
    }
  };
  static constexpr double most_known = 1e12;  ///< [W] where nothing bounds it

  void reset() noexcept {
    flow_.setZero(impedance_.size());
    push_.setZero(impedance_.size());
  }
  [[nodiscard]] static double length_of(const Vec<any_size>& v, const Group& group) noexcept {
    double square = 0.0;
    for (Eigen::Index i = group.first; i < group.end; ++i) square += v.coeff(i) * v.coeff(i);
    return std::sqrt(square);
  }
  static void scale(Vec<any_size>& v, const Group& group, double share) noexcept {
    for (Eigen::Index i = group.first; i < group.end; ++i) v.coeffRef(i) *= share;
  }

  void set_bounds() noexcept {
    const double size = static_cast<double>(impedance_.size());
    const double a = bounds_.motion_scale * scale_.value();
    const double b = bounds_.force_scale * scale_.value();
    const auto all = static_cast<Eigen::Index>(size);
    const auto Z = [&](Eigen::Index i) { return i < all ? impedance_.diagonal().coeff(i) : 1.0; };
    const double force = std::min(bounds_.force, bounds_.hand_force / b);
    const double torque = std::min(bounds_.torque, bounds_.hand_torque / b);
    switch (space_) {
      case Space::tool:
        groups_[0] = {0, all - 3, Z(0), force, bounds_.speed};
        groups_[1] = {all - 3, all, Z(all - 1), torque, bounds_.turning};
        break;
      case Space::lever:
        groups_[0] = {0, all, Z(0), force * b, bounds_.speed / a};
        groups_[1] = {};
        break;
      default:
        groups_[0] = {0, all, Z(0), force, bounds_.turning};
        groups_[1] = {};
    }
    const double u = groups_[0].most_wave();
    const double w = groups_[1].most_wave();
    most_power_ = std::min(most_known, u * u + w * w);
  }
  void cut_to_force(double& u, const Group& group, Eigen::Index i) const noexcept {
    const double root = 2.0 * std::sqrt(group.Z);
    const double along = std::copysign(1.0, u) * flow_.coeff(i);
    const double most = std::max(0.0, group.force + group.Z * std::min(along, group.speed)) / root;
    u = std::clamp(u, -most, most);
  }
  void cut_to_speed(Vec<any_size>& wave, const Group& group) const noexcept {
    const double length = length_of(wave, group);
    if (!(length > 0.0)) return;
    double along = 0.0;  // [N] pushed already
    for (Eigen::Index i = group.first; i < group.end; ++i) {
      along += wave.coeff(i) / length * push_.coeff(i);
    }
    const double most = (std::max(0.0, along) + group.Z * speed_along(wave, length, group)) /
                        (2.0 * std::sqrt(group.Z));
    if (length > most) scale(wave, group, most / length);
  }
  /// [m/s, rad/s] Greatest flow in the direction of a wave.
  [[nodiscard]] double speed_along(const Vec<any_size>& wave, double length,
                                   const Group& group) const noexcept {
    if (space_ != Space::joints || jacobian_.cols() != wave.size()) return group.speed;
    const Vec<any_size> tool = dense::product<Vec<any_size>>(jacobian_, wave);
    const double moved = three(tool, 0).norm() / length;  // [m] of the tool per [rad]
    return std::min(group.speed, bounds_.speed / std::max(moved, 1e-9));
  }

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
