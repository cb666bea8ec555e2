// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// ARM_OBSTACLE: the virtual forces of the world model on the links of the arm.
#pragma once

#include <repel/base/field.hpp>
#include <repel/network/elements/series_source.hpp>

namespace repel::network {

/// Of the passivity controller of an ArmObstacle.
struct ArmObstacleOptions {
  double most_energy = 5.0;     ///< [J] see PassivityOptions
  double most_damping = 300.0;  ///< [N m s/rad] limit of the damping against energy from sampling

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"most_energy", "J", 0.0, 1e6}, o.most_energy);
    visit(Field{"most_damping", "N m s/rad", 0.0, 1e6}, o.most_damping);
  }
};

/// A series source of torque on the joints: f_left = f_right - sum over the links of J^T F, with F
/// the virtual forces on a link. Forces of the arm's links on its own tool are included: a pair of
/// two bodies of one arm is stored energy of its joints. The counterpart of OBSTACLE for the links.
/// It must stand between PUMA_KIN and the robot, with nothing compliant on its right. One passivity
/// controller observes the energy of all joints together: one joint may return energy absorbed by
/// another.
class ArmObstacle : public JointSource {
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

  /// Adds the damping of the passivity controller.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept;
  /// Energy balance of all joints together.
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by moving obstacles

 private:
  static PassivityOptions passivity_of(const ArmObstacleOptions& options);

  ArmObstacleOptions options_;
  PassivityController<any_size> controller_;
  double supplied_ = 0.0;
  double damping_ = 0.0;  // [N m s/rad] of the passivity controller in this tick
};

}  // namespace repel::network
