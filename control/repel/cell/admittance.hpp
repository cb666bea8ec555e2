// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms commanded by joint rates or positions, not torques: the end of the network, from efforts to
/// such commands.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// How an arm commanded by rates or positions answers to the network: as joints with a virtual
/// inertia and friction.
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

/// The kinematics of an arm, with the virtual inertia of its admittance and without weight.
class AdmittedKinematics final : public ArmKinematics {
 public:
  AdmittedKinematics(std::unique_ptr<ArmKinematics> arm, std::vector<double> inertia)
      : arm_(std::move(arm)), inertia_(std::move(inertia)) {}

  void update(std::span<const double> q) noexcept override { arm_->update(q); }
  [[nodiscard]] Pose X_WT() const noexcept override { return arm_->X_WT(); }
  void tool_jacobian(JacobianRef J) const noexcept override { arm_->tool_jacobian(J); }
  void gravity_torques(std::span<double> out) noexcept override;
  [[nodiscard]] Pose X_WL(int link) const noexcept override { return arm_->X_WL(link); }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override;
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override;

 private:
  std::unique_ptr<ArmKinematics> arm_;
  std::vector<double> inertia_;  // [kg m^2] or [kg]
};

/// The virtual inertia of each joint [kg m^2] or [kg].
[[nodiscard]] std::vector<double> shown_inertia(const ArmDescription& arm,
                                                const AdmittanceOptions& options);

}  // namespace detail

/// The description of an arm as its admittance shows it, for a cell of `period` [s]: inertia,
/// friction and efforts of the model are those of the admittance, and the delay of the drive is its
/// response. All checks of the cell then apply to it. Set-up only.
/// @throws SetupError for an option out of range, or a joint whose inertia is not known
[[nodiscard]] ArmDescription admitted(ArmDescription arm, const AdmittanceOptions& options,
                                      double period);

/// The admittance of each joint: v' = (tau - B v) / M, within the limits of speed, acceleration and
/// position, and not further ahead of the arm than a sound arm lags behind. Motion the arm cannot
/// follow is given up, so a blocked arm does not jump when it comes free. Allocates at construction
/// only; a tick costs a few operations for each joint.
class JointAdmittance {
 public:
  /// @param model as `admitted` returns it @param response [s] of AdmittanceOptions
  /// @param period [s]
  JointAdmittance(const ArmModel& model, double response, double period);

  /// The commands of a tick. @param readings of the arm, at the start of the tick
  /// @param torques of TickRecord @param stop the arm is to brake: its brakes are requested, or
  /// engaged
  void step(const ArmReadings& readings, std::span<const double> torques, bool stop) noexcept;

  /// Commands to the arm [rad/s] or [m/s], and [rad] or [m]: it takes one or the other.
  [[nodiscard]] std::span<const double> rates() const noexcept {
    return {rates_.data(), rates_.size()};
  }
  /// Commanded positions [rad] or [m], one for each joint.
  [[nodiscard]] std::span<const double> positions() const noexcept {
    return {positions_.data(), positions_.size()};
  }

 private:
  [[nodiscard]] double most_change(std::size_t i) const noexcept;
  void brake(std::size_t i) noexcept;

  void advance(std::size_t i, double q, double v, double torque, bool stop) noexcept;

  std::vector<ArmLink> links_;
  double response_;  // [s] including the hold of a command and of a reading
  double period_;    // [s]
  std::vector<double> rates_, positions_;
  std::vector<double> lag_;  // [rad] lag of a sound arm at most
  bool has_begun_ = false;
};

}  // namespace repel
