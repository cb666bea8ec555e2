// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// KBB2: a virtual coupling, spring K parallel to damper B, with a shunt damper B2.
#pragma once

#include <cmath>

#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

/// Gains of the coupling, for translation and rotation. Lever and joint spaces, which have no such
/// distinction, use the first group. Stiffness and damping may be `automatic`: see `suited`.
struct Kbb2Options {
  double stiffness = 2000.0;        ///< K [N/m]
  double damping = 120.0;           ///< B [N s/m]
  double shunt = 0.0;               ///< B2 [N s/m]; 0: none
  double force_limit = 60.0;        ///< [N] the spring force saturates here
  double angular_stiffness = 60.0;  ///< [N m/rad]
  double angular_damping = 4.0;     ///< [N m s/rad]
  double angular_shunt = 0.0;       ///< [N m s/rad]
  double torque_limit = 8.0;        ///< [N m]
};

/// The left side moves the far end of a spring and a parallel damper whose near end is on the
/// right. R = K T / 2 + B. The shunt B2 to ground is on the left, where the waves of a line arrive:
/// with B2 equal to the impedance of the line, a right side that moves freely reflects nothing.
///
/// At its limit the far end of the spring is dragged along, so that a blocked tool causes no
/// wind-up and the force drops at once when the operator reverses. That only removes energy from
/// the spring.
class Kbb2 {
 public:
  static constexpr Traits traits{};  ///< any space on both sides

  /// @throws SetupError for a number out of range
  explicit Kbb2(const Kbb2Options& options = {}) : options_(options) {
    detail::checked_gain("stiffness", options.stiffness, 1e-3, 1e7, "N/m");
    detail::checked_gain("damping", options.damping, 0.0, 1e6, "N s/m");
    checked("shunt", options.shunt, 0.0, 1e6, "N s/m");
    checked("force limit", options.force_limit, 0.0, 1e6, "N");
    detail::checked_gain("angular stiffness", options.angular_stiffness, 1e-3, 1e6, "N m/rad");
    detail::checked_gain("angular damping", options.angular_damping, 0.0, 1e6, "N m s/rad");
    checked("angular shunt", options.angular_shunt, 0.0, 1e6, "N m s/rad");
    checked("torque limit", options.torque_limit, 0.0, 1e6, "N m");
  }

  /// Chooses the gains that are `automatic`; those of the defaults for an arm without a known mass.
  /// The damper has no limit of its own: at the greatest speed of the tool, and at 1 rad/s, it adds
  /// no more than that of the spring, or it would push a blocked tool into a wall.
  void suit(const RobotEnd& robot) noexcept {
    constexpr Kbb2Options usual;
    constexpr double turning = 1.0;  // [rad/s]
    Kbb2Options& o = options_;
    const Gains linear = suited({o.stiffness, o.damping}, robot.mass, robot.response,
                                {usual.stiffness, usual.damping}, o.force_limit / robot.speed);
    const Gains angular =
        suited({o.angular_stiffness, o.angular_damping}, robot.inertia, robot.response,
               {usual.angular_stiffness, usual.angular_damping}, o.torque_limit / turning);
    o.stiffness = linear.stiffness;
    o.damping = linear.damping;
    o.angular_stiffness = angular.stiffness;
    o.angular_damping = angular.damping;
  }
  /// Sets the size of its port, and the gains for that space.
  void fit(Space space, int size) {
    const bool tool = space == Space::tool;
    rotations_ = tool ? 3 : 0;
    const auto fill = [&](Vec<any_size>& gain, double linear, double angular) {
      gain.setConstant(size, linear);
      for (Eigen::Index i = tool ? size - 3 : size; i < size; ++i) gain.coeffRef(i) = angular;
    };
    fill(stiffness_, options_.stiffness, options_.angular_stiffness);
    fill(damping_, options_.damping, options_.angular_damping);
    fill(shunt_, options_.shunt, options_.angular_shunt);
    wave_.setZero(size);
  }
  /// @param period [s] of the network.
  void prepare(double period) {
    spring_resistance_ = 0.5 * detail::checked_period(period) * stiffness_;
    conductance_ = inverse(spring_resistance_ + damping_);
    has_shunt_ = !shunt_.isZero(0.0);
    none_.setZero(shunt_.size());
  }
  /// On which side the robot is.
  void face(Side root) noexcept { root_ = root; }
  /// Releases the spring where no force of the operator is to act.
  void read(const Signals& signals) noexcept {
    if (signals.at_rest) wave_.setZero();
  }

  /// What is behind, with shunt and spring-damper. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    shown = behind;
    if (root_ == Side::right) add_shunt(shown);
    shown.add_diagonal_admittance(conductance_, -product(conductance_, wave_));
    if (!has_shunt_ || root_ == Side::right) return true;
    if (!shown.take_form(Form::impedance)) return false;
    add_shunt(shown);
    return true;
  }
  /// Effort and flow behind; advances the spring.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    at_leaf = at_root;
    if (root_ == Side::left) at_leaf.effort -= product(shunt_, at_leaf.flow);
    effort_ = at_leaf.effort;
    for (Eigen::Index i = 0; i < wave_.size(); ++i) {
      const double relative = conductance_.coeff(i) * (effort_.coeff(i) - wave_.coeff(i));
      at_leaf.flow.coeffRef(i) -= relative;
      wave_.coeffRef(i) += 2.0 * (spring_resistance_.coeff(i) * relative);
    }
    if (root_ == Side::right) at_leaf.effort -= product(shunt_, at_leaf.flow);
    limit();
  }

  /// Effort through spring and damper on the side away from the root [N, N m].
  [[nodiscard]] const Vec<any_size>& effort() const noexcept { return effort_; }
  /// Energy stored in the spring [J].
  [[nodiscard]] double stored() const noexcept {
    return 0.5 * product(wave_, wave_).dot(inverse(stiffness_));
  }
  /// With the gains in use.
  [[nodiscard]] const Kbb2Options& options() const noexcept { return options_; }
  /// True when the spring was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  [[nodiscard]] static Vec<any_size> inverse(Vec<any_size> diagonal) noexcept {
    for (double& x : diagonal) x = 1.0 / x;
    return diagonal;
  }
  void scale(Eigen::Index first, Eigen::Index count, double share) noexcept {
    for (Eigen::Index i = first; i < first + count; ++i) wave_.coeffRef(i) *= share;
  }
  void add_shunt(Equivalent<any_size>& shown) const noexcept {
    if (has_shunt_) shown.add_impedance(shunt_.asDiagonal(), none_);
  }
  // The wave of a spring is its force at the end of the tick.
  void limit() noexcept {
    const Eigen::Index linear = wave_.size() - rotations_;
    const double force = wave_.head(linear).norm();
    saturated_ = force > options_.force_limit;
    if (saturated_) scale(0, linear, options_.force_limit / force);
    if (rotations_ == 0) return;
    const double torque = three(wave_, linear).norm();
    if (!(torque > options_.torque_limit)) return;
    saturated_ = true;
    scale(linear, 3, options_.torque_limit / torque);
  }

  Kbb2Options options_;
  Side root_ = Side::right;
  Eigen::Index rotations_ = 0;
  bool has_shunt_ = false;
  Vec<any_size> stiffness_, damping_, shunt_, none_;  // diagonals
  Vec<any_size> spring_resistance_, conductance_;
  Vec<any_size> wave_;    // of the spring [N, N m]
  Vec<any_size> effort_;  // [N, N m]
  bool saturated_ = false;
};

}  // namespace repel::network
