// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/puma_joints.hpp>

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::network {

MeasuredFlow::MeasuredFlow(int joints)
    : position_(Vec<any_size>::Zero(joints)),
      mean_(position_),
      integral_(position_),
      flow_(position_) {}

void MeasuredFlow::reset(const Vec<any_size>& q) noexcept {
  position_ = integral_ = q;
  flow_.setZero();
  mean_.setZero();
}

void MeasuredFlow::step(const Vec<any_size>& q, const Vec<any_size>& rate, double period,
                        double elapsed) noexcept {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    double& flow = flow_.coeffRef(i);
    double& integral = integral_.coeffRef(i);
    mean_.coeffRef(i) = (q.coeff(i) - position_.coeff(i)) / (elapsed > 0.0 ? elapsed : period);
    const double error = q.coeff(i) - integral - 0.5 * period * (flow + rate.coeff(i));
    integral += 0.5 * period * flow;
    flow = rate.coeff(i) + error * 2.0 / (trim_time + period);
    integral += 0.5 * period * flow;
  }
  position_ = q;
}

PumaJoints::PumaJoints(int joints)
    : flow_(Vec<any_size>::Zero(
          static_cast<int>(checked("number of joints", joints, 1, most_joints, "")))),
      effort_(flow_) {}

void PumaJoints::read(const Signals& signals) noexcept {
  if (signals.sent.size() == effort_.size()) limit_to(signals.sent);
  const double gained = signals.period * effort_.dot(signals.mean_rates - flow_) +
                        (signals.since_last() - signals.period) * effort_.dot(signals.mean_rates);
  if (gained - gained == 0.0) sampling_energy_ += gained;  // finite: a fault does not spoil it
  flow_ = signals.rates;
}

void PumaJoints::limit_to(const Vec<any_size>& sent) noexcept {
  for (Eigen::Index i = 0; i < sent.size(); ++i) {
    double& effort = effort_.coeffRef(i);
    const double most = effort * sent.coeff(i) > 0.0 ? std::abs(sent.coeff(i)) : 0.0;
    effort = std::clamp(effort, -most, most);
  }
}

void PumaJoints::equivalent(Equivalent<any_size>& shown) const noexcept {
  shown.form = Form::admittance;
  shown.matrix.setZero(flow_.size(), flow_.size());
  shown.offset = flow_;
}

}  // namespace repel::network
