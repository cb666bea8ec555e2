// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// LIMITS: virtual springs and dampers ahead of the joint stops.
#pragma once

#include <optional>
#include <vector>

#include <repel/base/field.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/series_source.hpp>

namespace repel::network {

/// A one-sided spring-damper at each end of a joint's range. It only pushes inward. Stiffness and
/// damping may be `automatic`: see `suited`, with the inertia of each joint.
struct JointLimits {
  double range = 0.1;         ///< [rad] or [m] distance before the limit at which it begins to act
  double stiffness = 2000.0;  ///< [N m/rad] or [N/m]
  double damping = 20.0;      ///< [N m s/rad] or [N s/m]; raised where the tick rate and the delay
                              ///< of the drive need more

  /// The torque [N m] at position `q` moving at `v`, for a joint between `lower` and `upper`.
  [[nodiscard]] double operator()(double q, double v, double lower, double upper) const noexcept;

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"stiffness", "N m/rad", 0.0, 1e6, true}, o.stiffness);
    visit(Field{"damping", "N m s/rad", 0.0, 1e6, true}, o.damping);
  }
};

/// Range of one joint [rad] or [m]; infinite for a continuous joint.
struct JointRange {
  double lower = 0.0;  ///< [rad] or [m]
  double upper = 0.0;  ///< [rad] or [m]
  /// [rad] or [m] replaces JointLimits::range for this joint: revolute and prismatic joints cannot
  /// share one number
  std::optional<double> zone{};
};

/// Adds the torques of the limits to those from the left, at the same joint rates; each joint
/// separately and with its own passivity controller. Where the zones of both limits overlap, the
/// lower limit acts.
class Limits : public JointSource {
 public:
  /// For the planner.
  static constexpr Traits traits{
      .left = Space::joints, .right = Space::joints, .needs_flow = true, .keeps_flow = true};

  /// @throws SetupError for a number out of range or an upper limit below the lower one
  Limits(const JointLimits& law, const std::vector<JointRange>& ranges);

  /// Number of joints.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(joints_.size()); }
  /// Chooses the gains that are `automatic`; those of the defaults for an arm without known masses.
  void suit(const RobotEnd& robot) noexcept;
  /// Raises the damping of each joint to the stability limit of its sampled spring: K T / 2, more
  /// for a late drive.
  void prepare(double period);

  /// Takes the torques of the limits, corrected by the passivity controllers.
  void read(const Signals& signals) noexcept;

  /// Adds the damping of laws and passivity controllers [N m s/rad], on the diagonal.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept;
  /// The law of a joint, with the gains in use.
  [[nodiscard]] const JointLimits& law(int joint) const noexcept;
  /// True while a joint is within `range` of its limit and is pushed back.
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// The largest torque [N m], or force [N], on a joint since set-up.
  [[nodiscard]] double most_torque(int joint) const noexcept;
  /// Sum over all joints.
  [[nodiscard]] PassivityReport passivity() const noexcept;

 private:
  struct Joint {
    JointLimits law;
    JointRange range;
    PassivityController<1> controller;
    double damping = 0.0;  // [N m s/rad] of law and controller in this tick
    double rate = 0.0;     // [rad/s] of the last tick
    double most = 0.0;     // [N m] torque
  };
  double wall_ticks_ = 0.5;
  std::vector<Joint> joints_;
  bool active_ = false;
};

}  // namespace repel::network
