// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms that take joint rates or positions, not torques: the end of the network that turns its
/// efforts into such commands.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cell/description.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/network/plan.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// How an arm that is commanded by rates or positions answers to the network: as joints with an
/// inertia and a friction of their own, which exist in the controller only.
struct AdmittanceOptions {
  /// [kg m^2] or [kg] of each joint, 1e-6 to 1e6; empty: the diagonal of the arm's own inertia
  /// matrix at its start, times `scale`
  std::vector<double> inertia{};
  double scale = 1.0;         ///< 1e-3 to 1e3
  double rest_time = 0.3;     ///< [s] in which a joint without effort loses 63 % of its rate
  double acceleration = 0.0;  ///< [rad/s^2] or [m/s^2] of the commands; 0: what the efforts allow
  /// [s] from a commanded rate to the rate of the arm: dead time plus the lag of its own loop. A
  /// wall of stiffness K needs a damping of (0.5 T + 2 response) K, and the operator's side is as
  /// much softer as that of a drive so late (docs/network/prediction.md).
  double response = 0.03;
};

namespace detail {

/// The kinematics of an arm, with the inertia that its admittance shows and without weight.
class AdmittedKinematics final : public ArmKinematics {
 public:
  AdmittedKinematics(std::unique_ptr<ArmKinematics> arm, std::vector<double> inertia)
      : arm_(std::move(arm)), inertia_(std::move(inertia)) {}

  void update(std::span<const double> q) noexcept override { arm_->update(q); }
  [[nodiscard]] Pose X_WT() const noexcept override { return arm_->X_WT(); }
  void tool_jacobian(JacobianRef J) const noexcept override { arm_->tool_jacobian(J); }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }
  [[nodiscard]] Pose X_WL(int link) const noexcept override { return arm_->X_WL(link); }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    arm_->jacobian(link, p_WQ, J);
  }
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    const auto size = static_cast<Eigen::Index>(inertia_.size());
    M.setZero(size, size);
    for (Eigen::Index i = 0; i < size; ++i) M(i, i) = inertia_[static_cast<std::size_t>(i)];
    return true;
  }

 private:
  std::unique_ptr<ArmKinematics> arm_;
  std::vector<double> inertia_;  // [kg m^2] or [kg]
};

/// The inertia that each joint shows [kg m^2] or [kg].
[[nodiscard]] inline std::vector<double> shown_inertia(const ArmDescription& arm,
                                                       const AdmittanceOptions& options) {
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

}  // namespace detail

/// The description of an arm as its admittance shows it, for a cell of `period` [s]: inertia,
/// friction and efforts of the model are those of the admittance, and the delay of the drive is its
/// response. All checks of the cell then apply to it. Set-up only.
/// @throws SetupError for an option out of range, or a joint whose inertia is not known
[[nodiscard]] inline ArmDescription admitted(ArmDescription arm, const AdmittanceOptions& options,
                                             double period) {
  checked("admittance rest time", options.rest_time, 1e-3, 1e3, "s");
  checked("admittance acceleration", options.acceleration, 0.0, 1e4, "rad/s^2");
  checked("admittance response", options.response, 0.0, 100.0 * period, "s");
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

/// The admittance of each joint: v' = (tau - B v) / M, within the limits of speed, acceleration and
/// position, and not further ahead of the arm than a sound arm lags behind. What the arm cannot
/// follow is given up, so that an arm that was blocked does not jump. Allocates at construction
/// only; a tick costs a few operations for each joint.
class JointAdmittance {
 public:
  /// @param model as `admitted` returns it @param response [s] of AdmittanceOptions
  /// @param period [s]
  JointAdmittance(const ArmModel& model, double response, double period)
      : links_(model.links),
        response_(response + 2.0 * period),
        period_(period),
        rates_(model.links.size()),
        positions_(model.links.size()),
        lag_(model.links.size()) {}

  /// The commands of a tick. @param readings of the arm, at the start of the tick
  /// @param torques of TickRecord @param stop the arm is to brake: its brakes are requested, or
  /// engaged
  void step(const ArmReadings& readings, std::span<const double> torques, bool stop) noexcept {
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

  /// Commands to the arm [rad/s] or [m/s], and [rad] or [m]: it takes one or the other.
  [[nodiscard]] std::span<const double> rates() const noexcept { return rates_; }
  /// [rad] or [m] that the joints are to be at, one for each.
  [[nodiscard]] std::span<const double> positions() const noexcept { return positions_; }

 private:
  [[nodiscard]] double most_change(std::size_t i) const noexcept {
    return period_ * links_[i].effort_limit / links_[i].rotor_inertia;
  }
  void brake(std::size_t i) noexcept {
    const double change = most_change(i);
    rates_[i] -= std::clamp(rates_[i], -change, change);
  }

  void advance(std::size_t i, double q, double v, double torque, bool stop) noexcept {
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

  std::vector<ArmLink> links_;
  double response_;  // [s] with that of a command that is held, and of a reading
  double period_;    // [s]
  std::vector<double> rates_, positions_;
  std::vector<double> lag_;  // [rad] by which a sound arm may be behind
  bool has_begun_ = false;
};

}  // namespace repel
