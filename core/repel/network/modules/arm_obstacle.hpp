// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// ARM_OBSTACLE: the virtual forces of the world model on the links of the arm.
#pragma once

#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/two_port.hpp>

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
  explicit ArmObstacle(const ArmObstacleOptions& options = {})
      : options_(options), controller_(passivity_of(options), Vec<any_size>::Ones(1)) {
    checked("most energy", options.most_energy, 0.0, 1e6, "J");
    checked("most damping", options.most_damping, 0.0, 1e6, "N m s/rad");
  }

  /// For an arm of `size` joints.
  void fit(Space /*space*/, int size) {
    controller_ = PassivityController<any_size>(passivity_of(options_), Vec<any_size>::Ones(size));
    effort_.setZero(size);
  }

  /// Takes the torques of the walls on the links, corrected by the passivity controller.
  void read(const Signals& signals) noexcept {
    effort_ = -signals.arm_torques;
    if (signals.released) {
      controller_.reset();
      effort_.setZero();
      supplied_ = damping_ = 0.0;
      return;
    }
    supplied_ = signals.arm_power;
    damping_ = controller_.step(effort_, signals.rates, signals.mean_rates, signals.period,
                                supplied_, signals.since_last());
    if (damping_ > 0.0) effort_ += damping_ * signals.rates;
  }

  /// What is behind, and the torques in series. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    return series::shown(behind, effort_, shown);
  }
  /// The same rates; the torques of the walls have been taken off.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept {
    series::pass(at_root, effort_, at_leaf);
  }

  /// Torques of the walls on the joints, after the passivity controller [N m].
  [[nodiscard]] Vec<any_size> torques() const noexcept { return -effort_; }
  /// Adds the torques of the walls [N m].
  void add_walls(const Jacobian& /*of_tool*/, Vec<any_size>& torques) const noexcept {
    torques += this->torques();
  }
  /// Adds the damping of the passivity controller.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept {
    for (Eigen::Index i = 0; i < damping.rows(); ++i) damping.coeffRef(i, i) += damping_;
  }
  /// Energy balance of all joints together.
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by moving obstacles

 private:
  static PassivityOptions passivity_of(const ArmObstacleOptions& options) {
    return {.most_energy = options.most_energy, .most_damping = options.most_damping, .lever = 1.0};
  }

  ArmObstacleOptions options_;
  PassivityController<any_size> controller_;
  Vec<any_size> effort_;  // into the module [N m]
  double supplied_ = 0.0;
  double damping_ = 0.0;  // [N m s/rad] of the passivity controller in this tick
};

}  // namespace repel::network
