/// @file
/// KBB2: a virtual coupling, spring K parallel to damper B, with a shunt damper B2.
#pragma once

#include <cmath>

#include <repel/network/two_port.hpp>

namespace repel::network {

/// Gains of the coupling; translation and rotation apart. In the spaces of a lever and of joints,
/// where there is no such difference, the first group holds.
struct Kbb2Options {
  double stiffness = 2000.0;        ///< K [N/m]
  double damping = 120.0;           ///< B [N s/m]
  double shunt = 0.0;               ///< B2 [N s/m]; 0: none
  double force_limit = 60.0;        ///< [N] the spring stretches no further than this
  double angular_stiffness = 60.0;  ///< [N m/rad]
  double angular_damping = 4.0;     ///< [N m s/rad]
  double angular_shunt = 0.0;       ///< [N m s/rad]
  double torque_limit = 8.0;        ///< [N m]
};

/// What is on the left moves the far end of a spring and a damper whose near end is on the right.
/// R = K T / 2 + B. The shunt B2 to the ground stands on the left, where the waves of a line
/// arrive: with B2 at the impedance of the line, what moves freely on the right reflects nothing.
///
/// Where the spring reaches its limit its far end is dragged along, so that a held-up tool winds
/// nothing up and lets go at once when the operator turns back. That only takes energy from it.
class Kbb2 {
 public:
  static constexpr Traits traits{};

  /// @throws SetupError for a number out of range
  explicit Kbb2(const Kbb2Options& options = {}) : options_(options) {
    checked("stiffness", options.stiffness, 1e-3, 1e7, "N/m");
    checked("damping", options.damping, 0.0, 1e6, "N s/m");
    checked("shunt", options.shunt, 0.0, 1e6, "N s/m");
    checked("force limit", options.force_limit, 0.0, 1e6, "N");
    checked("angular stiffness", options.angular_stiffness, 1e-3, 1e6, "N m/rad");
    checked("angular damping", options.angular_damping, 0.0, 1e6, "N m s/rad");
    checked("angular shunt", options.angular_shunt, 0.0, 1e6, "N m s/rad");
    checked("torque limit", options.torque_limit, 0.0, 1e6, "N m");
  }

  /// Takes the size of the port it stands at.
  void fit(Space space, int size) {
    const bool tool = space == Space::tool;
    rotations_ = tool ? 3 : 0;
    const auto fill = [&](Vec<any_size>& gain, double linear, double angular) {
      gain.setConstant(size, linear);
      if (tool) gain.tail<3>().setConstant(angular);
    };
    fill(stiffness_, options_.stiffness, options_.angular_stiffness);
    fill(damping_, options_.damping, options_.angular_damping);
    fill(shunt_, options_.shunt, options_.angular_shunt);
    wave_.setZero(size);
  }
  void prepare(double period) {
    spring_resistance_ = 0.5 * detail::checked_period(period) * stiffness_;
    conductance_ = (spring_resistance_ + damping_).cwiseInverse();
    has_shunt_ = !shunt_.isZero(0.0);
    none_.setZero(shunt_.size());
  }
  void face(Side root) noexcept { root_ = root; }
  void read(const Signals& signals) noexcept {
    if (signals.at_rest) wave_.setZero();
  }

  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    shown = behind;
    if (root_ == Side::right) add_shunt(shown);
    shown.add_admittance(conductance_.asDiagonal(), -conductance_.cwiseProduct(wave_));
    if (!shown.take_form(Form::impedance)) return false;
    if (root_ == Side::left) add_shunt(shown);
    return true;
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    at_leaf = at_root;
    if (root_ == Side::left) at_leaf.effort -= shunt_.cwiseProduct(at_leaf.flow);
    const Vec<any_size> relative = conductance_.cwiseProduct(at_leaf.effort - wave_);
    at_leaf.flow -= relative;
    effort_ = at_leaf.effort;
    if (root_ == Side::right) at_leaf.effort -= shunt_.cwiseProduct(at_leaf.flow);
    wave_ += 2.0 * spring_resistance_.cwiseProduct(relative);
    limit();
  }

  /// Through spring and damper, as it acts on the side away from the root [N, N m].
  [[nodiscard]] const Vec<any_size>& effort() const noexcept { return effort_; }
  /// In the spring [J].
  [[nodiscard]] double stored() const noexcept {
    return 0.5 * wave_.cwiseAbs2().dot(stiffness_.cwiseInverse());
  }
  /// True when the spring was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  void add_shunt(Equivalent<any_size>& shown) const noexcept {
    if (has_shunt_) shown.add_impedance(shunt_.asDiagonal(), none_);
  }
  // The wave of a spring is its force at the end of the tick.
  void limit() noexcept {
    const Eigen::Index linear = wave_.size() - rotations_;
    const double force = wave_.head(linear).norm();
    saturated_ = force > options_.force_limit;
    if (saturated_) wave_.head(linear) *= options_.force_limit / force;
    if (rotations_ == 0) return;
    const double torque = wave_.tail<3>().norm();
    if (!(torque > options_.torque_limit)) return;
    saturated_ = true;
    wave_.tail<3>() *= options_.torque_limit / torque;
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
