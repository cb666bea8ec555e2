// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/limits.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::network {

double JointLimits::operator()(double q, double v, double lower, double upper) const noexcept {
  const double below = lower + range - q;
  const double above = q - (upper - range);
  if (below > 0.0) return std::max(0.0, stiffness * below - damping * v);
  if (above > 0.0) return std::min(0.0, -stiffness * above - damping * v);
  return 0.0;
}

Limits::Limits(const JointLimits& law, const std::vector<JointRange>& ranges) {
  checked("range", law.range, 1e-6, 1e3, "rad");
  checked_fields(law);
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

void Limits::suit(const RobotEnd& robot) noexcept {
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

void Limits::prepare(double period) {
  const double least = wall_ticks_ * detail::checked_period(period);
  for (Joint& joint : joints_) {
    joint.law.damping = std::max(joint.law.damping, least * joint.law.stiffness);
  }
}

void Limits::read(const Signals& signals) noexcept {
  active_ = false;
  for (Eigen::Index i = 0; i < effort_.size(); ++i) {
    Joint& joint = joints_[static_cast<std::size_t>(i)];
    const double rate = signals.rates(i);
    if (signals.foreseen.size() == effort_.size() && joint.damping > 0.0) {
      const Vec<1> less(-joint.damping * signals.foreseen(i));
      joint.controller.give_up(less, Vec<1>(joint.rate), signals.period);
    }
    joint.rate = rate;
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

void Limits::add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept {
  for (Eigen::Index i = 0; i < damping.rows(); ++i) {
    damping.coeffRef(i, i) += joints_[static_cast<std::size_t>(i)].damping;
  }
}

const JointLimits& Limits::law(int joint) const noexcept {
  return joints_[static_cast<std::size_t>(joint)].law;
}

double Limits::most_torque(int joint) const noexcept {
  return joints_[static_cast<std::size_t>(joint)].most;
}

PassivityReport Limits::passivity() const noexcept {
  PassivityReport sum;
  for (const Joint& joint : joints_) {
    sum.dissipated += joint.controller.report().dissipated;
    sum.owed += joint.controller.report().owed;
  }
  return sum;
}

}  // namespace repel::network
