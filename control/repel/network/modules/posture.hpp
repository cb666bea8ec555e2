// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// POSTURE: a spring and a damper on the null-space motion of the joints.
#pragma once

#include <vector>

#include <repel/base/field.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/series_source.hpp>

namespace repel::network {

/// The spring and damper of a Posture, the same for each joint; for a prismatic one as N and m.
struct PostureOptions {
  double stiffness = 10.0;       ///< [N m/rad]
  double damping = 2.0;          ///< [N m s/rad]; raised where the tick rate and the delay of the
                                 ///< drive need more
  double torque_limit = 20.0;    ///< [N m] of spring and damper, on each joint
  double most_energy = 5.0;      ///< [J] see PassivityOptions
  double most_damping = 300.0;   ///< [N m s/rad] limit of the damping against energy from sampling
  std::vector<double> joints{};  ///< [rad] or [m] of the slack spring; empty: the position in the
                                 ///< first tick, and in the first after a release

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"stiffness", "N m/rad", 0.0, 1e6}, o.stiffness);
    visit(Field{"damping", "N m s/rad", 0.0, 1e6}, o.damping);
    visit(Field{"torque_limit", "N m", 0.0, 1e6}, o.torque_limit);
    visit(Field{"most_energy", "J", 0.0, 1e6}, o.most_energy);
    visit(Field{"most_damping", "N m s/rad", 0.0, 1e6}, o.most_damping);
  }
};

/// A series source of torque in the null space of the tool, for arms with joints to spare:
///
///     tau = -P (K (q - q0) + B P qdot)
///
/// P projects on the null space of the Jacobian J: with the eigenvectors n of J' J and their
/// eigenvalues s^2, P = sum g n n', g = (1 - (s / s0)^2)^2 below s0 and 0 above, where s0 is
/// `singular` times the greatest s. So P is I - J^+ J in a regular pose, zero for six joints there,
/// and a direction lost by the tool near a singular pose enters it continuously.
///
/// As v = P qdot and tau = P x, power is kept: spring, damper and passivity controller act at a
/// port of their own, x . v = tau . qdot, and push nothing but the null space. The projected spring
/// has no potential, so it gives back the energy of spring and damper, up to `most_energy`. With
/// given positions it begins charged; that energy counts as supplied. It must stand between
/// PUMA_KIN and the robot, with nothing compliant on its right.
class Posture : public JointSource {
 public:
  /// For the planner.
  static constexpr Traits traits{
      .left = Space::joints, .right = Space::joints, .needs_flow = true, .keeps_flow = true};
  /// Null-space motion begins below this share of the greatest motion of the tool, 1 rad counted as
  /// 0.3 m.
  static constexpr double singular = 0.01;

  /// @throws SetupError for a number out of range
  explicit Posture(PostureOptions options = {});

  /// Takes the stability limits of this arm.
  void suit(const RobotEnd& robot) noexcept { wall_ticks_ = robot.wall_ticks; }
  /// For an arm of `size` joints.
  /// @throws SetupError if positions are given, and not one for each joint
  void fit(Space /*space*/, int size);
  /// Raises the damping to the stability limit of the sampled spring: K T / 2, more for a late
  /// drive. @param period [s] of the network
  void prepare(double period);

  /// Takes the torques, corrected by the passivity controller. Cost: the eigenvectors of J' J, a
  /// few microseconds for seven joints.
  void read(const Signals& signals) noexcept;

  /// Adds the damping of law and passivity controller, through P on both sides.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept;
  /// P of this tick.
  [[nodiscard]] const Mat<any_size>& projector() const noexcept { return projector_; }
  /// Stiffness and damping in use.
  [[nodiscard]] const PostureOptions& options() const noexcept { return options_; }
  /// Energy balance of all joints together.
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] as it is charged

 private:
  void release() noexcept;
  void project(const Jacobian& jacobian) noexcept;
  void begin(const Signals& signals) noexcept;

  PostureOptions options_;
  PassivityController<any_size> controller_;
  double wall_ticks_ = 0.5;
  bool has_begun_ = false;
  Vec<any_size> slack_;      // q0
  Mat<any_size> projector_;  // P
  double damping_ = 0.0;     // [N m s/rad] of law and controller in this tick
  double supplied_ = 0.0;
};

}  // namespace repel::network
