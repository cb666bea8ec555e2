// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// KBB2: a virtual coupling, spring K parallel to damper B, with a shunt damper B2.
#pragma once

#include <repel/base/field.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/signals.hpp>

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

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"stiffness", "N/m", 1e-3, 1e7, true}, o.stiffness);
    visit(Field{"damping", "N s/m", 0.0, 1e6, true}, o.damping);
    visit(Field{"shunt", "N s/m", 0.0, 1e6}, o.shunt);
    visit(Field{"force_limit", "N", 0.0, 1e6}, o.force_limit);
    visit(Field{"angular_stiffness", "N m/rad", 1e-3, 1e6, true}, o.angular_stiffness);
    visit(Field{"angular_damping", "N m s/rad", 0.0, 1e6, true}, o.angular_damping);
    visit(Field{"angular_shunt", "N m s/rad", 0.0, 1e6}, o.angular_shunt);
    visit(Field{"torque_limit", "N m", 0.0, 1e6}, o.torque_limit);
  }
};

/// A spring and a parallel damper. The left side moves their far end; the near end is on the right.
/// R = K T / 2 + B. The shunt B2 to ground is on the left, towards a line: with B2 equal to the
/// impedance of the line, a free right side reflects nothing.
///
/// At its limit the far end of the spring is dragged along, so that a blocked tool causes no
/// wind-up and the force drops at once when the operator reverses. That only removes energy from
/// the spring.
class Kbb2 {
 public:
  static constexpr Traits traits{};  ///< any space on both sides

  /// @throws SetupError for a number out of range
  explicit Kbb2(const Kbb2Options& options = {});

  /// Chooses the gains that are `automatic`; those of the defaults for an arm without a known mass.
  /// The damper has no limit of its own: at the greatest speed of the tool, and at 1 rad/s, it adds
  /// no more than the spring limit. More would push a blocked tool into a wall.
  void suit(const RobotEnd& robot) noexcept;
  /// Sets the size of its port, and the gains for that space.
  void fit(Space space, int size);
  /// @param period [s] of the network.
  void prepare(double period);
  /// On which side the robot is.
  void face(Side root) noexcept { root_ = root; }
  /// Releases the spring while the operator's force is removed.
  void read(const Signals& signals) noexcept;

  /// What is behind, with shunt and spring-damper. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// Effort and flow behind; advances the spring.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept;

  /// Effort through spring and damper on the side away from the root [N, N m].
  [[nodiscard]] const Vec<any_size>& effort() const noexcept { return effort_; }
  /// Energy stored in the spring [J].
  [[nodiscard]] double stored() const noexcept;
  /// With the gains in use.
  [[nodiscard]] const Kbb2Options& options() const noexcept { return options_; }
  /// True when the spring was at its limit in this tick.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  [[nodiscard]] static Vec<any_size> inverse(Vec<any_size> diagonal) noexcept;
  void scale(Eigen::Index first, Eigen::Index count, double share) noexcept;
  void add_shunt(Equivalent<any_size>& shown) const noexcept;
  // The wave of a spring is its force at the end of the tick.
  void limit() noexcept;

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
