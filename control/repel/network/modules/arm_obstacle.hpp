// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// ARM_OBSTACLE: the virtual forces of the world model on the links of the arm.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// Of the passivity controller of an ArmObstacle.
struct ArmObstacleOptions {
  double most_energy = 5.0;     ///< [J] see PassivityOptions
  double most_damping = 300.0;  ///< [N m s/rad] limit of the damping against energy from sampling
};

/// A series source of torque on the joints: f_left = f_right - sum over the links of J^T F, with F
/// the virtual forces on a link. Where links of the arm push its own tool, that force is among
/// them: a pair of two bodies of one arm is stored energy of its joints. The counterpart of
/// OBSTACLE for the links. It must stand between PUMA_KIN and the robot, with nothing compliant on
/// its right. One passivity controller observes the energy of all joints together: one joint may
/// return energy that another has absorbed.
class ArmObstacle {
 public:
  /// For the planner.
  static constexpr Traits traits{.left = Space::joints,
                                 .right = Space::joints,
                                 .needs_flow = true,
                                 .keeps_flow = true,
                                 .walls = Walls::links};

  /// @throws SetupError for a number out of range.
  explicit ArmObstacle(const ArmObstacleOptions& options = {});

  /// For an arm of `size` joints.
  void fit(Space /*space*/, int size);

  /// Takes the torques of the walls on the links, corrected by the passivity controller.
  void read(const Signals& signals) noexcept;

  /// What is behind, and the torques in series. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same rates; the torques of the walls have been taken off.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept;

  /// Torques of the walls on the joints, after the passivity controller [N m].
  [[nodiscard]] Vec<any_size> torques() const noexcept { return -effort_; }
  /// Adds the torques of the walls [N m].
  void add_walls(const Jacobian& /*of_tool*/, Vec<any_size>& torques) const noexcept;
  /// Adds the damping of the passivity controller.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept;
  /// Energy balance of all joints together.
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by moving obstacles

 private:
  static PassivityOptions passivity_of(const ArmObstacleOptions& options);

  ArmObstacleOptions options_;
  PassivityController<any_size> controller_;
  Vec<any_size> effort_;  // into the module [N m]
  double supplied_ = 0.0;
  double damping_ = 0.0;  // [N m s/rad] of the passivity controller in this tick
};

}  // namespace repel::network
