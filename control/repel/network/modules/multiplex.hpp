// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// MULTIPLEX: couples a one-degree-of-freedom device to the six degrees of freedom of the tool.
#pragma once

#include <repel/base/field.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// Scales of a lever, and how it turns.
struct MultiplexOptions {
  double velocity_scale = 0.1;  ///< s_v [m/rad] tool motion per lever motion
  double force_scale = 0.1;     ///< s_f [m] lever torque per tool force; s_f = s_v is lossless
  double turning_time = 0.05;   ///< [s] time constant with which the direction follows a new one
  Hand hand = Hand::first;      ///< of the lever

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"velocity_scale", "m/rad", 1e-6, 100.0}, o.velocity_scale);
    visit(Field{"force_scale", "m", 1e-6, 100.0}, o.force_scale);
    visit(Field{"turning_time", "s", 0.0, 100.0}, o.turning_time);
    visit(Choice{"hand", {"first", "second"}}, o.hand);
  }
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
  explicit Multiplex(const MultiplexOptions& options = {});

  /// @param period [s] of the network.
  void prepare(double period);
  /// On which side the robot is.
  void face(Side root) noexcept { root_ = root; }

  /// Follows the direction and the scale of the hand.
  void read(const Signals& signals) noexcept;

  /// What is behind, through the transformer. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// State behind, through the transformer.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                PortState<any_size>& at_leaf) const noexcept;

  /// s_f / s_v, the power at the lever as a part of that at the tool.
  [[nodiscard]] double power_factor() const noexcept;
  /// Weight of the left port's power in the ledger.
  [[nodiscard]] double left_weight() const noexcept { return 1.0 / power_factor(); }
  /// The hand whose lever it is.
  [[nodiscard]] Hand hand() const noexcept { return options_.hand; }
  /// s_v [m/rad].
  [[nodiscard]] double velocity_scale() const noexcept;
  /// s_v [m/rad] times the scale of the hand, in this tick.
  [[nodiscard]] double flow_scale() const noexcept;
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
