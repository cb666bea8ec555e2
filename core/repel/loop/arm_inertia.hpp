/// @file
/// The mass that an arm puts up at its joints, from its links where they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <repel/network/port.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// What a joint can give where its file knows no limit: twice the weight it may have to carry and
/// 50 rad/s^2 (m/s^2) of what it moves, all of it stretched out, and no less than 200 N m or 1000
/// N. Its own limit where there is one. [N m] or [N]; finite. Not for the tick.
[[nodiscard]] inline double effort_bound(const ArmModel& model, std::size_t joint) {
  const ArmLink& at = model.links[joint];
  if (at.effort_limit > 0.0 && std::isfinite(at.effort_limit)) return at.effort_limit;
  const bool turns = at.type == JointType::revolute;
  const double g = model.gravity_W.norm();
  double weight = 0.0;
  double inertia = at.rotor_inertia;
  double reach = 0.0;  // of the frame of a link from the joint, stretched out
  for (std::size_t k = joint; k < model.links.size(); ++k) {
    const ArmLink& link = model.links[k];
    if (k > joint) reach += link.X_PJ.translation().norm();
    const double lever = turns ? reach + link.p_LC.norm() : 1.0;
    weight += link.mass * g * lever;
    inertia += link.mass * lever * lever + (turns ? link.I_C_L.norm() : 0.0);
  }
  return std::clamp(2.0 * weight + 50.0 * inertia, turns ? 200.0 : 1000.0, 1e6);
}

/// The inertia matrix of an arm at its joints,
///
///     M = sum over the links of  m Jv' Jv + Jw' I Jw     and the rotors on the diagonal
///
/// with Jv that of the centre of mass. A joint of which nothing is known to have mass is taken to
/// move what its effort accelerates by 100 m/s^2. Memory is taken at construction.
class ArmInertia {
 public:
  using Vector = network::Vec<network::any_size>;
  using Matrix = network::Mat<network::any_size>;

  explicit ArmInertia(const ArmModel& model)
      : model_(model), drawn_(Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, size())) {
    M_.setZero(size(), size());
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      nominal_.push_back(0.01 * effort_bound(model, i));
    }
  }

  /// Brings M to where `kinematics` is. Cost: a Jacobian for each link.
  template <ArmKinematics Kinematics>
  void update(const Kinematics& kinematics) noexcept {
    for (Eigen::Index i = 0; i < size(); ++i) {
      for (Eigen::Index k = 0; k < size(); ++k) M_(i, k) = 0.0;
    }
    for (Eigen::Index k = 0; k < size(); ++k) {
      const ArmLink& link = model_.links[static_cast<std::size_t>(k)];
      if (link.mass > 0.0 || !link.I_C_L.isZero(0.0)) add(kinematics, link, static_cast<int>(k));
    }
    for (Eigen::Index i = 0; i < size(); ++i) {
      const auto joint = static_cast<std::size_t>(i);
      M_(i, i) += model_.links[joint].rotor_inertia;
      if (!(M_(i, i) > 1e-9)) M_(i, i) = nominal_[joint];
      for (Eigen::Index k = 0; k < i; ++k) M_(k, i) = M_(i, k);
    }
  }

  /// [kg m^2] or [kg], symmetric.
  [[nodiscard]] const Matrix& matrix() const noexcept { return M_; }

  /// Momenta M v [kg m^2/s] or [kg m/s].
  void momenta(const std::vector<double>& v, Vector& out) const noexcept {
    out.resize(size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < size(); ++k) sum += M_(i, k) * v[static_cast<std::size_t>(k)];
      out(i) = sum;
    }
  }

 private:
  [[nodiscard]] Eigen::Index size() const noexcept {
    return static_cast<Eigen::Index>(model_.links.size());
  }

  // The lower triangle.
  template <ArmKinematics Kinematics>
  void add(const Kinematics& kinematics, const ArmLink& link, int index) noexcept {
    const Pose& X_WL = kinematics.X_WL(index);
    kinematics.jacobian(index, X_WL * link.p_LC, drawn_);
    const Mat3 I_W = X_WL.linear() * link.I_C_L * X_WL.linear().transpose();
    for (Eigen::Index i = 0; i <= index; ++i) {
      const Vec3 force = link.mass * drawn_.col(i).template head<3>();
      const Vec3 torque = I_W * drawn_.col(i).template tail<3>();
      for (Eigen::Index k = 0; k <= i; ++k) {
        M_(i, k) += force.dot(drawn_.col(k).template head<3>()) +
                    torque.dot(drawn_.col(k).template tail<3>());
      }
    }
  }

  const ArmModel& model_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> drawn_;
  Matrix M_;
  std::vector<double> nominal_;  // [kg m^2] or [kg]
};

}  // namespace repel
