// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/admittance.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/loop/arms/arm_inertia.hpp>

namespace repel::detail {

void AdmittedKinematics::gravity_torques(std::span<double> out) noexcept {
  std::fill(out.begin(), out.end(), 0.0);
}

void AdmittedKinematics::jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept {
  arm_->jacobian(link, p_WQ, J);
}

bool AdmittedKinematics::mass_matrix(Eigen::MatrixXd& M) const noexcept {
  const auto size = static_cast<Eigen::Index>(inertia_.size());
  M.setZero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) M(i, i) = inertia_[static_cast<std::size_t>(i)];
  return true;
}

std::vector<double> shown_inertia(const ArmDescription& arm, const AdmittanceOptions& options) {
  const std::size_t joints = arm.model.links.size();
  std::vector<double> shown = options.inertia;
  if (shown.empty()) {
    checked("admittance scale", options.scale, 1e-3, 1e3, "");
    std::vector<double> q = arm.start;
    q.resize(joints, 0.0);
    arm.kinematics->update(q);
    ArmInertia own(arm.model);
    const bool is_sound = own.update(*arm.kinematics);
    if (own.missing() >= 0) {
      const auto joint = static_cast<std::size_t>(own.missing());
      throw SetupError("joint '" + arm.model.links[joint].joint_name +
                       "' moves no mass where the arm starts; allowed: an inertia for each joint "
                       "in AdmittanceOptions");
    }
    if (!is_sound) throw SetupError(unsound_mass);
    for (std::size_t i = 0; i < joints; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      shown.push_back(options.scale * own.matrix().coeff(at, at));
    }
  }
  if (shown.size() != joints) {
    throw SetupError("admittance of " + std::to_string(shown.size()) + " joints for an arm of " +
                     std::to_string(joints) + "; allowed: an inertia for each joint, or none");
  }
  for (const double inertia : shown) checked("admittance inertia", inertia, 1e-6, 1e6, "kg m^2");
  return shown;
}

}  // namespace repel::detail

namespace repel {

ArmDescription admitted(ArmDescription arm, const AdmittanceOptions& options, double period) {
  checked("admittance rest time", options.rest_time, 1e-3, 1e3, "s");
  checked("admittance acceleration", options.acceleration, 0.0, 1e4, "rad/s^2");
  checked("admittance response at " + to_text(1.0 / period, 6) + " Hz", options.response, 0.0,
          100.0 * period, "s");
  if (!arm.kinematics) throw SetupError("an arm needs kinematics");
  std::vector<double> inertia = detail::shown_inertia(arm, options);
  std::vector<double> effort;
  for (std::size_t i = 0; i < inertia.size(); ++i) effort.push_back(effort_bound(arm.model, i));
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    ArmLink& link = arm.model.links[i];
    link.mass = 0.0;
    link.I_C_L.setZero();
    link.rotor_inertia = inertia[i];
    link.viscous_friction = inertia[i] / options.rest_time;
    link.coulomb_friction = 0.0;
    link.effort_limit = effort[i];
    if (options.acceleration > 0.0) {
      link.effort_limit = std::min(effort[i], inertia[i] * options.acceleration);
    }
  }
  arm.model.gravity_W.setZero();
  arm.options.drive_delay += options.response / period;
  // It reports the same position until it answers, and where its own loop lets friction hold it.
  arm.options.joints.touches = true;
  arm.takes_motion = true;
  arm.response += options.response;
  arm.options.joints.repeats += 2 * static_cast<int>(std::ceil(arm.options.drive_delay));
  arm.kinematics =
      std::make_unique<detail::AdmittedKinematics>(std::move(arm.kinematics), std::move(inertia));
  return arm;
}

JointAdmittance::JointAdmittance(const ArmModel& model, double response, double period)
    : links_(model.links),
      response_(response + 2.0 * period),
      period_(period),
      rates_(model.links.size()),
      positions_(model.links.size()),
      lag_(model.links.size()) {}

void JointAdmittance::step(const ArmReadings& readings, std::span<const double> torques,
                           bool stop) noexcept {
  const bool is_held = readings.state != ArmState::enabled || !has_begun_;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const double q = i < readings.q.size() ? readings.q[i] : positions_[i];
    const double v = i < readings.v.size() ? readings.v[i] : 0.0;
    if (q - q != 0.0 || v - v != 0.0) {
      brake(i);
      positions_[i] += period_ * rates_[i];
    } else if (is_held) {
      rates_[i] = 0.0;
      positions_[i] = q;
      lag_[i] = 0.0;
      has_begun_ = true;
    } else {
      advance(i, q, v, i < torques.size() ? torques[i] : 0.0, stop);
    }
  }
}

double JointAdmittance::most_change(std::size_t i) const noexcept {
  return period_ * links_[i].effort_limit / links_[i].rotor_inertia;
}

void JointAdmittance::brake(std::size_t i) noexcept {
  const double change = most_change(i);
  rates_[i] -= std::clamp(rates_[i], -change, change);
}

void JointAdmittance::advance(std::size_t i, double q, double v, double torque,
                              bool stop) noexcept {
  const ArmLink& link = links_[i];
  double& rate = rates_[i];
  if (stop) {
    brake(i);
  } else {
    const double kept = 1.0 + period_ * link.viscous_friction / link.rotor_inertia;
    rate = (rate + period_ * torque / link.rotor_inertia) / kept;
  }
  if (link.velocity_limit > 0.0) {
    rate = std::clamp(rate, -link.velocity_limit, link.velocity_limit);
  }
  // What a sound arm is behind by: the change of the command within its response, and the way.
  const double ahead = 2.0 * (most_change(i) / period_) * response_ + 1e-3;
  rate = std::clamp(rate, v - ahead, v + ahead);
  const double speed = std::max(std::abs(v), std::abs(rate));
  lag_[i] = std::max(speed * response_, lag_[i] * (1.0 - period_ / response_));
  const double most = 2.0 * lag_[i] + 2e-3;
  double position = std::clamp(positions_[i] + period_ * rate, q - most, q + most);
  if (link.lower < link.upper) position = std::clamp(position, link.lower, link.upper);
  // A rate that leads out of the range is not sent.
  if (position == link.upper) rate = std::min(rate, 0.0);
  if (position == link.lower) rate = std::max(rate, 0.0);
  positions_[i] = position;
}

}  // namespace repel
