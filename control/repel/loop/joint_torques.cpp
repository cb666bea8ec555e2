// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/joint_torques.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel {

JointTorques::JointTorques(const ArmModel& model, double period, const JointTorqueOptions& options,
                           double drive_delay)
    : model_(model),
      friction_(model.links.size()),
      period_(period),
      brake_time_(
          std::max(checked("brake time", options.brake_time, 1e-4, 10.0, "s"), 4.0 * period)),
      slew_(std::min(1.0, period / checked("slew time", options.slew_time, 0.0, 10.0, "s"))),
      gravity_(model.links.size()),
      last_gravity_(gravity_),
      torques_(model.links.size()),
      sum_(torques_),
      lower_(torques_),
      upper_(torques_),
      step_(std::max(period, options.slew_time)),
      until_(drive_delay * period + 0.5 * (period + step_)),
      // Half as much again as until the torque has acted: the mass of the model may be off.
      speeds_(model, (2.0 + 1.5 * drive_delay) * period + 0.5 * options.slew_time),
      problem_(model.links.size(), BarrierRows::most + most_rounds * (model.links.size() + 1)) {
  for (std::size_t i = 0; i < model.links.size(); ++i) effort_.push_back(effort_bound(model, i));
  const auto size = static_cast<Eigen::Index>(model.links.size());
  net_.setZero(size);
  walls_ = wanted_ = brake_ = alone_ = rate_ = net_;
}

Status JointTorques::compose(const Vector& network, const Vector& walls, const TorqueShares& s,
                             const std::vector<double>& v, const ArmInertia& inertia,
                             const TorqueBounds& bounds) noexcept {
  const bool sound = keep_sound(network, walls);
  Status found = sound ? 0U : status::bad_torque;
  const TorqueShares given =
      sound ? s : TorqueShares{.operators = 0.0, .walls = 0.0, .friction = 0.0, .brake = s.brake};
  share_out(network, walls, given, v);
  for (std::size_t i = 0; i < bounds.probes.size() && given.operators > 0.0; ++i) {
    probe(i, bounds.probes[i]);
  }
  const double braking = brake(given, v, inertia);
  for (std::size_t i = 0; i < torques_.size(); ++i) found |= bound(i);
  found |= decide(v, inertia, bounds);
  has_sent_ = true;
  expect(v, inertia, braking);
  alone_ = net_;
  const bool holds = bounds.barrier != nullptr && bounds.barrier->is_on();
  if (holds) bounds.barrier->note_sent(net_);
  if (holds || is_cut_) expect_together(v, inertia);
  return found;
}

Status JointTorques::decide(const std::vector<double>& v, const ArmInertia& inertia,
                            const TorqueBounds& bounds) noexcept {
  const bool is_near = bounds.barrier != nullptr && bounds.barrier->observe(v, inertia);
  is_cut_ = false;
  if (!begin(inertia)) {
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      torques_[i] = std::clamp(sum_[i], lower_[i], upper_[i]);
    }
    return is_near ? status::hold_lost : 0U;
  }
  speeds_.observe(bounds.q, inertia);
  const bool is_fast = speeds_.foresee(problem_.mass(), sum_, gravity_, v, bounds.tool);
  if (!is_near && !is_fast && is_within_range()) {
    std::copy(sum_.begin(), sum_.end(), torques_.begin());
    return 0;
  }
  problem_.ask(sum_, gravity_);
  if (is_near) bounds.barrier->bound(problem_, gravity_, v, inertia);
  int rounds = 0;
  do {
    is_cut_ = problem_.solve(lower_, upper_);
  } while (rounds++ < most_rounds && speeds_.bound(problem_, v, walls_, bounds.tool));
  Status found = 0;
  if (is_near) found |= bounds.barrier->account(problem_, lower_, upper_, effort_);
  if (is_cut_) found |= SpeedBounds::said(problem_);
  for (std::size_t i = 0; i < torques_.size(); ++i) {
    const double asked = std::clamp(sum_[i], -effort_[i], effort_[i]);
    const double within = std::clamp(asked, lower_[i], upper_[i]);
    // What a wall takes is no matter of how fast a torque may change.
    if (!is_near && std::abs(asked - within) > 1e-9 * effort_[i]) found |= status::torque_rate;
    torques_[i] = problem_.torque(i);
  }
  return found;
}

bool JointTorques::is_within_range() const noexcept {
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    if (sum_[i] < lower_[i] || sum_[i] > upper_[i]) return false;
  }
  return true;
}

bool JointTorques::begin(const ArmInertia& inertia) noexcept {
  const auto& M = inertia.matrix();
  const Eigen::Index n = M.rows();
  const auto entry = [&](Eigen::Index i) {
    const auto joint = static_cast<std::size_t>(i / n);
    const bool is_diagonal = i % (n + 1) == 0;
    return M.data()[i] + (is_diagonal ? until_ * model_.links[joint].viscous_friction : 0.0);
  };
  return problem_.begin(n, entry, step_);
}

bool JointTorques::keep_sound(const Vector& network, const Vector& walls) noexcept {
  bool sound = true;
  for (std::size_t i = 0; i < gravity_.size(); ++i) {
    sound = sound && is_number(network(index(i))) && is_number(walls(index(i)));
  }
  for (std::size_t i = 0; i < gravity_.size(); ++i) {
    if (is_number(gravity_[i])) {
      last_gravity_[i] = gravity_[i];
    } else {
      gravity_[i] = last_gravity_[i];
      sound = false;
    }
  }
  return sound;
}

void JointTorques::share_out(const Vector& network, const Vector& walls, const TorqueShares& s,
                             const std::vector<double>& v) noexcept {
  double power = 0.0;  // of the operator [W]
  for (std::size_t i = 0; i < v.size(); ++i) power += (network(index(i)) - walls(index(i))) * v[i];
  const double share = s.operators * (power > 0.0 ? s.drive : 1.0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    // A contribution of share zero may be NaN.
    walls_(index(i)) = s.walls > 0.0 ? s.walls * walls(index(i)) : 0.0;
    double asked = walls_(index(i));
    if (share > 0.0) asked += share * (network(index(i)) - walls(index(i)));
    gravity_[i] *= s.gravity;
    wanted_(index(i)) = asked + compensation(i, asked, s.friction);
  }
}

double JointTorques::compensation(std::size_t i, double asked, double share) noexcept {
  if (!(share > 0.0)) return friction_[i].part = 0.0;
  return share * friction_[i](model_.links[i].coulomb_friction, asked, period_);
}

void JointTorques::probe(std::size_t i, double level) noexcept {
  double& wanted = wanted_.coeffRef(index(i));
  if (level > 0.0) wanted = std::max(wanted, level);
  if (level < 0.0) wanted = std::min(wanted, level);
}

double JointTorques::brake(const TorqueShares& s, const std::vector<double>& v,
                           const ArmInertia& inertia) noexcept {
  double share = 0.0;
  if (s.brake > 0.0) {
    inertia.momenta(v, brake_);
    double taken = 0.0;
    double given = 0.0;  // by the walls [W]
    for (std::size_t i = 0; i < v.size(); ++i) {
      taken += brake_(index(i)) * v[i] / brake_time_;
      given += walls_(index(i)) * v[i];
    }
    share = s.brake;
    if (given > 0.0) share *= std::max(0.0, 1.0 - give_way * given / taken);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double b = -brake_(index(i)) / brake_time_;
      const double rest = gravity_[i] + wanted_(index(i));
      const double room = std::max(0.0, effort_[i] - (b > 0.0 ? rest : -rest));
      if (share * std::abs(b) > room) share = room / std::abs(b);
    }
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    brake_(index(i)) = share > 0.0 ? -share * brake_(index(i)) / brake_time_ : 0.0;
  }
  return share;
}

Status JointTorques::bound(std::size_t i) noexcept {
  Status found = 0;
  const double most = effort_[i];
  const double wish = gravity_[i] + wanted_(index(i)) + brake_(index(i));
  const double torque = std::clamp(wish, -most, most);
  if (torque != wish) found |= status::torque_limit;
  sum_[i] = wish;
  lower_[i] = -most;
  upper_[i] = most;
  if (!has_sent_) return found;
  lower_[i] = std::max(-most, torques_[i] - slew_ * most);
  upper_[i] = std::min(most, torques_[i] + slew_ * most);
  return found;
}

void JointTorques::expect(const std::vector<double>& v, const ArmInertia& inertia,
                          double braking) noexcept {
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double mass = inertia.matrix()(index(i), index(i));
    net_(index(i)) = torques_[i] - gravity_[i];
    const double push = net_(index(i)) - brake_(index(i));
    const double kept = v[i] * (1.0 - braking * period_ / brake_time_);
    rate_(index(i)) = slowed(i, mass * kept + period_ * push, v[i], mass);
  }
}

double JointTorques::slowed(std::size_t i, double momentum, double v, double mass) const noexcept {
  const ArmLink& link = model_.links[i];
  const double dry = period_ * link.coulomb_friction;
  const double left = std::max(0.0, std::abs(momentum) - dry);
  const double rate = std::copysign(left, momentum) / (mass + period_ * link.viscous_friction);
  if (!(link.velocity_limit > 0.0)) return rate;
  const double most = std::max(link.velocity_limit, std::abs(v));
  return std::clamp(rate, -most, most);
}

void JointTorques::expect_together(const std::vector<double>& v,
                                   const ArmInertia& inertia) noexcept {
  const ArmInertia::Matrix& M = inertia.matrix();
  if (!mass_.factor(M.rows(), [&](Eigen::Index i) { return M.data()[i]; })) return;
  mass_.solve(alone_);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double mass = M(index(i), index(i));
    double& alone = alone_.coeffRef(index(i));
    alone *= mass;
    rate_(index(i)) = slowed(i, mass * v[i] + period_ * alone, v[i], mass);
    // Friction may hold the others, so that they do not move this one.
    const double own = net_(index(i));
    alone = alone * own > 0.0 ? std::copysign(std::min(std::abs(alone), std::abs(own)), own) : 0.0;
  }
}

}  // namespace repel
