// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/joint_torques.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel {

double within_speed(double asked, double v, double limit) noexcept {
  constexpr double fade = 0.2;
  if (!(limit > 0.0) || std::isinf(limit) || !(asked * v > 0.0)) return asked;
  return asked * std::clamp((limit - std::abs(v)) / (fade * limit), 0.0, 1.0);
}

JointTorques::JointTorques(const ArmModel& model, double period, const JointTorqueOptions& options)
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
      upper_(torques_) {
  for (std::size_t i = 0; i < model.links.size(); ++i) effort_.push_back(effort_bound(model, i));
  const auto size = static_cast<Eigen::Index>(model.links.size());
  net_.setZero(size);
  wanted_ = brake_ = alone_ = rate_ = net_;
}

Status JointTorques::compose(const Vector& network, const Vector& walls, const TorqueShares& s,
                             const std::vector<double>& v, const ArmInertia& inertia,
                             EntryBarrier* barrier, std::span<const double> probes) noexcept {
  const bool sound = keep_sound(network, walls);
  Status found = sound ? 0U : status::bad_torque;
  const TorqueShares given =
      sound ? s : TorqueShares{.operators = 0.0, .walls = 0.0, .friction = 0.0, .brake = s.brake};
  if (share_out(network, walls, given, v)) found |= status::speed_limit;
  for (std::size_t i = 0; i < probes.size() && given.operators > 0.0; ++i) probe(i, probes[i]);
  const double braking = brake(walls, given, v, inertia);
  for (std::size_t i = 0; i < torques_.size(); ++i) found |= bound(i);
  if (barrier != nullptr) {
    found |= barrier->limit(sum_, gravity_, lower_, upper_, effort_, v, inertia);
  }
  for (std::size_t i = 0; i < torques_.size(); ++i) {
    torques_[i] = std::clamp(sum_[i], lower_[i], upper_[i]);
    const double most = std::clamp(sum_[i], -effort_[i], effort_[i]);
    if (std::abs(most - torques_[i]) > 1e-9 * effort_[i]) found |= status::torque_rate;
  }
  has_sent_ = true;
  expect(v, inertia, braking);
  alone_ = net_;
  if (barrier != nullptr && barrier->is_on()) {
    barrier->note_sent(net_);
    expect_together(v, inertia);
  }
  return found;
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

bool JointTorques::share_out(const Vector& network, const Vector& walls, const TorqueShares& s,
                             const std::vector<double>& v) noexcept {
  double power = 0.0;  // of the operator [W]
  for (std::size_t i = 0; i < v.size(); ++i) power += (network(index(i)) - walls(index(i))) * v[i];
  const double share = s.operators * (power > 0.0 ? s.drive : 1.0);
  bool is_kept = false;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const ArmLink& link = model_.links[i];
    // A contribution of share zero may be NaN.
    double wish = share > 0.0 ? share * (network(index(i)) - walls(index(i))) : 0.0;
    if (s.walls > 0.0) wish += s.walls * walls(index(i));
    const double asked = within_speed(wish, v[i], link.velocity_limit);
    is_kept = is_kept || asked != wish;
    gravity_[i] *= s.gravity;
    wanted_(index(i)) = asked + compensation(i, asked, s.friction);
  }
  return is_kept;
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

double JointTorques::brake(const Vector& walls, const TorqueShares& s, const std::vector<double>& v,
                           const ArmInertia& inertia) noexcept {
  double share = 0.0;
  if (s.brake > 0.0) {
    inertia.momenta(v, brake_);
    double taken = 0.0;
    double given = 0.0;  // by the walls [W]
    for (std::size_t i = 0; i < v.size(); ++i) {
      taken += brake_(index(i)) * v[i] / brake_time_;
      if (s.walls > 0.0) given += s.walls * walls(index(i)) * v[i];
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
  sum_[i] = torque;
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
