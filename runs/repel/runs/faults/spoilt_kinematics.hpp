// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kinematics with a fault.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <repel/runs/faults/exchange.hpp>

namespace repel::faults {

/// What kinematics answer of the tool, changed by a fault; all else as they do.
class SpoiltKinematics final : public ArmKinematics {
 public:
  /// @param sound kinematics @param exchange of their arm, which outlives this @param fault null:
  /// none
  SpoiltKinematics(std::unique_ptr<ArmKinematics> sound, Exchange& exchange, const Fault* fault)
      : sound_(std::move(sound)), x_(exchange), fault_(fault) {}

  void update(std::span<const double> q) noexcept override {
    sound_->update(q);
    Answers& a = x_.answers;
    a.X_WT = sound_->X_WT();
    sound_->tool_jacobian(a.J);
    sound_->gravity_torques(a.gravity);
    has_mass_ = sound_->mass_matrix(a.M);
    if (x_.since < 0) x_.known = a;
    if (fault_ != nullptr) fault_->act(Kind::kinematics, x_);
  }
  [[nodiscard]] Pose X_WT() const noexcept override { return x_.answers.X_WT; }
  void tool_jacobian(JacobianRef J) const noexcept override { J = x_.answers.J; }
  void gravity_torques(std::span<double> out) noexcept override {
    std::copy(x_.answers.gravity.begin(), x_.answers.gravity.end(), out.begin());
  }
  [[nodiscard]] Pose X_WL(int link) const noexcept override { return sound_->X_WL(link); }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    sound_->jacobian(link, p_WQ, J);
  }
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    M = x_.answers.M;
    return has_mass_;
  }

 private:
  std::unique_ptr<ArmKinematics> sound_;
  Exchange& x_;
  const Fault* fault_;
  bool has_mass_ = true;
};

}  // namespace repel::faults
