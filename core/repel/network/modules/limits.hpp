// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// LIMITS: virtual springs and dampers ahead of the joint stops.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

/// A one-sided spring-damper at each end of a joint's range. It only pushes inward. Stiffness and
/// damping may be `automatic`: see `suited`, with the inertia of each joint.
struct JointLimits {
  double range = 0.1;         ///< [rad] or [m] distance before the limit at which it begins to act
  double stiffness = 2000.0;  ///< [N m/rad] or [N/m]
  double damping = 20.0;      ///< [N m s/rad] or [N s/m]; raised where the tick rate and the delay
                              ///< of the drive need more

  /// The torque [N m] at position `q` moving at `v`, for a joint between `lower` and `upper`.
  [[nodiscard]] double operator()(double q, double v, double lower, double upper) const noexcept {
    const double below = lower + range - q;
    const double above = q - (upper - range);
    if (below > 0.0) return std::max(0.0, stiffness * below - damping * v);
    if (above > 0.0) return std::min(0.0, -stiffness * above - damping * v);
    return 0.0;
  }
};

/// Range of one joint [rad] or [m]; infinite for a continuous joint.
struct JointRange {
  double lower = 0.0;  ///< [rad] or [m]
  double upper = 0.0;  ///< [rad] or [m]
  /// [rad] or [m] replaces JointLimits::range for this joint: joints that turn and joints that
  /// slide cannot share one number
  std::optional<double> zone{};
};

/// Adds the torques of the limits to those from the left, at the same joint rates; each joint
/// separately and with its own passivity controller. Where the zones of both limits overlap, the
/// lower limit acts.
class Limits {
 public:
  /// For the planner.
  static constexpr Traits traits{
      .left = Space::joints, .right = Space::joints, .needs_flow = true, .keeps_flow = true};

  /// @throws SetupError for a number out of range or an upper limit below the lower one
  Limits(const JointLimits& law, const std::vector<JointRange>& ranges) {
    checked("range", law.range, 1e-6, 1e3, "rad");
    detail::checked_gain("stiffness", law.stiffness, 0.0, 1e6, "N m/rad");
    detail::checked_gain("damping", law.damping, 0.0, 1e6, "N m s/rad");
    checked("number of joints", static_cast<double>(ranges.size()), 1, most_joints, "");
    for (const JointRange& range : ranges) {
      if (!std::isinf(range.lower)) checked("lower limit", range.lower, -1e6, 1e6, "rad");
      if (!std::isinf(range.upper)) checked("upper limit", range.upper, range.lower, 1e6, "rad");
      JointLimits own = law;
      if (range.zone) own.range = checked("zone", *range.zone, 1e-6, 1e3, "rad or m");
      joints_.push_back({own, range, PassivityController<1>({.lever = 1.0}, Vec<1>::Ones()), 0.0});
    }
    effort_.setZero(static_cast<Eigen::Index>(ranges.size()));
  }

  /// Number of joints.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(joints_.size()); }
  /// Chooses the gains that are `automatic`; those of the defaults for an arm without known masses.
  void suit(const RobotEnd& robot) noexcept {
    wall_ticks_ = robot.wall_ticks;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      JointLimits& law = joints_[i].law;
      const auto joint = static_cast<Eigen::Index>(i);
      const double inertia = joint < robot.joints.size() ? robot.joints.coeff(joint) : 0.0;
      const Gains gains = suited({law.stiffness, law.damping}, inertia, robot.response,
                                 {JointLimits{}.stiffness, JointLimits{}.damping});
      law.stiffness = gains.stiffness;
      law.damping = gains.damping;
    }
  }
  /// Raises the damping of each joint to what keeps its sampled spring stable: K T / 2 and more
  /// where the drive is late.
  void prepare(double period) {
    const double least = wall_ticks_ * detail::checked_period(period);
    for (Joint& joint : joints_) {
      joint.law.damping = std::max(joint.law.damping, least * joint.law.stiffness);
    }
  }

  /// Takes the torques of the limits, corrected by the passivity controllers.
  void read(const Signals& signals) noexcept {
    active_ = false;
    for (Eigen::Index i = 0; i < effort_.size(); ++i) {
      Joint& joint = joints_[static_cast<std::size_t>(i)];
      const double rate = signals.rates(i);
      Vec<1> effort(-joint.law(signals.joints(i), rate, joint.range.lower, joint.range.upper));
      const bool acts = effort(0) != 0.0;
      active_ = active_ || acts;
      const double damping =
          joint.controller.step(effort, Vec<1>(rate), Vec<1>(signals.mean_rates(i)), signals.period,
                                0.0, signals.since_last());
      effort(0) += rate * damping;
      effort_(i) = effort(0);
      joint.most = std::max(joint.most, std::abs(effort(0)));
      joint.damping = damping + (acts ? joint.law.damping : 0.0);
    }
  }

  /// What is behind, and the torques in series. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    return series::shown(behind, effort_, shown);
  }
  /// The same rates, less the torques.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept {
    series::pass(at_root, effort_, at_leaf);
  }

  /// Torques of the limits on the joints [N m].
  [[nodiscard]] Vec<any_size> torques() const noexcept { return -effort_; }
  /// Adds the torques of the limits [N m].
  void add_walls(const Jacobian& /*of_tool*/, Vec<any_size>& torques) const noexcept {
    torques += this->torques();
  }
  /// Adds the damping of laws and passivity controllers [N m s/rad], on the diagonal.
  void add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept {
    for (Eigen::Index i = 0; i < damping.rows(); ++i) {
      damping.coeffRef(i, i) += joints_[static_cast<std::size_t>(i)].damping;
    }
  }
  /// The law of a joint, with the gains in use.
  [[nodiscard]] const JointLimits& law(int joint) const noexcept {
    return joints_[static_cast<std::size_t>(joint)].law;
  }
  /// True while a joint is within `range` of its limit and is pushed back.
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// The largest torque [N m], or force [N], on a joint since set-up.
  [[nodiscard]] double most_torque(int joint) const noexcept {
    return joints_[static_cast<std::size_t>(joint)].most;
  }
  /// Sum over all joints.
  [[nodiscard]] PassivityReport passivity() const noexcept {
    PassivityReport sum;
    for (const Joint& joint : joints_) {
      sum.dissipated += joint.controller.report().dissipated;
      sum.owed += joint.controller.report().owed;
    }
    return sum;
  }

 private:
  struct Joint {
    JointLimits law;
    JointRange range;
    PassivityController<1> controller;
    double damping = 0.0;  // [N m s/rad] of law and controller in this tick
    double most = 0.0;     // [N m] torque
  };
  double wall_ticks_ = 0.5;
  std::vector<Joint> joints_;
  Vec<any_size> effort_;  // into the module [N m]
  bool active_ = false;
};

}  // namespace repel::network
