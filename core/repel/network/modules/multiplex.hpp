// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// MULTIPLEX: couples a one-degree-of-freedom device to the six degrees of freedom of the tool.
#pragma once

#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

/// Scales of a lever, and how it turns.
struct MultiplexOptions {
  double velocity_scale = 0.1;  ///< s_v [m/rad] tool motion per lever motion
  double force_scale = 0.1;     ///< s_f [m] lever torque per tool force; s_f = s_v is lossless
  double turning_time = 0.05;   ///< [s] time constant with which the direction follows a new one
  Hand hand = Hand::first;      ///< of the lever
};

/// A transformer along one twist d, a direction [1] and a turning [rad/m]: v6 = s_v d v1 and f1 =
/// s_f d.f6. The other five directions of the tool side have zero flow, whatever the effort. With
/// no turning, the tool is moved along the direction; with both along one axis it is screwed.
///
/// A new d is approached as d += (new - d)(1 - exp(-T / turning_time)). The transformer is lossless
/// for any d, also of length below one, so the change injects no energy and no effort jumps. Both
/// scales are multiplied by HandInput::scale (ChangingScale).
///
/// With s_f != s_v the lever receives s_f / s_v of the power at the tool; the ledger therefore
/// weights the power at the lever by s_v / s_f.
class Multiplex {
 public:
  /// A lever on the left, a tool on the right.
  static constexpr Traits traits{.left = Space::lever, .right = Space::tool};

  /// @throws SetupError for a number out of range
  explicit Multiplex(const MultiplexOptions& options = {}) : options_(options) {
    checked("velocity scale", options.velocity_scale, 1e-6, 100.0, "m/rad");
    checked("force scale", options.force_scale, 1e-6, 100.0, "m");
    checked("turning time", options.turning_time, 0.0, 100.0, "s");
  }

  /// @param period [s] of the network.
  void prepare(double period) {
    const double time = options_.turning_time;
    share_ = time > 0.0 ? -std::expm1(-detail::checked_period(period) / time) : 1.0;
    scale_.prepare(period);
  }
  /// On which side the robot is.
  void face(Side root) noexcept { root_ = root; }

  /// Follows the direction and the scale of the hand.
  void read(const Signals& signals) noexcept {
    const HandInput& hand = signals.of(options_.hand);
    direction_ = begun_ ? direction_ + share_ * (hand.direction_W - direction_) : hand.direction_W;
    turning_ = begun_ ? turning_ + share_ * (hand.turning_W - turning_) : hand.turning_W;
    begun_ = true;
    scale_.step(hand.scale);
    for (int i = 0; i < 3; ++i) {
      flow_map_[i] = scale_.value() * options_.velocity_scale * direction_[i];
      effort_map_[i] = scale_.value() * options_.force_scale * direction_[i];
      flow_map_[3 + i] = scale_.value() * options_.velocity_scale * turning_[i];
      effort_map_[3 + i] = scale_.value() * options_.force_scale * turning_[i];
    }
  }

  /// What is behind, through the transformer. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    if (root_ != Side::right) {
      return transformer::shown_at_b(behind, flow_map_, effort_map_, shown);
    }
    Equivalent<any_size> lever = behind;
    if (!lever.take_form(Form::admittance)) return false;
    shown.form = Form::admittance;
    shown.matrix.resize(6, 6);
    shown.offset.resize(6);
    const dense::Six flow(flow_map_.data());
    for (int k = 0; k < 6; ++k) {
      const double share = lever.matrix.coeff(0, 0) * effort_map_[k];
      flow.times(share).store(shown.matrix.col(k).data());
    }
    flow.times(lever.offset.coeff(0)).store(shown.offset.data());
    return true;
  }
  /// State behind, through the transformer.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                PortState<any_size>& at_leaf) const noexcept {
    if (root_ == Side::right) {
      transformer::to_b(at_root, behind, effort_map_, at_leaf);
    } else {
      transformer::to_a(at_root, behind, flow_map_, at_leaf);
    }
  }

  /// s_f / s_v, the power at the lever as a part of that at the tool.
  [[nodiscard]] double power_factor() const noexcept {
    return options_.force_scale / options_.velocity_scale;
  }
  /// Weight of the left port's power in the ledger.
  [[nodiscard]] double left_weight() const noexcept { return 1.0 / power_factor(); }
  /// The hand whose lever it is.
  [[nodiscard]] Hand hand() const noexcept { return options_.hand; }
  [[nodiscard]] double velocity_scale() const noexcept {  ///< s_v [m/rad]
    return options_.velocity_scale;
  }
  /// s_v [m/rad] times the scale of the hand, in this tick.
  [[nodiscard]] double flow_scale() const noexcept {
    return scale_.value() * options_.velocity_scale;
  }
  /// The direction of d, world axes; of length below one while it changes.
  [[nodiscard]] const Vec3& direction() const noexcept { return direction_; }
  /// [rad/m] The turning of d, world axes.
  [[nodiscard]] const Vec3& turning() const noexcept { return turning_; }

 private:
  using Column = Eigen::Matrix<double, 6, 1>;
  MultiplexOptions options_;
  ChangingScale scale_;
  Side root_ = Side::right;
  double share_ = 1.0;
  bool begun_ = false;
  Vec3 direction_{1, 0, 0};
  Vec3 turning_{0, 0, 0};
  Column flow_map_ = Column::Zero();    // [m/rad, rad/rad]
  Column effort_map_ = Column::Zero();  // [m, rad]
};

}  // namespace repel::network
