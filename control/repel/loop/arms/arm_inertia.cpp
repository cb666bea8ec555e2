// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/arm_inertia.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <repel/loop/arms/arm_bodies.hpp>

namespace repel {

double effort_bound(const ArmModel& model, std::size_t joint) {
  const ArmLink& at = model.links[joint];
  if (at.effort_limit > 0.0 && std::isfinite(at.effort_limit)) return at.effort_limit;
  const bool turns = at.type == JointType::revolute;
  const double g = model.gravity_W.norm();
  double weight = 0.0;
  double inertia = at.rotor_inertia;
  double reach = 0.0;  // from the joint to the frame of a link, stretched out
  for (std::size_t k = joint; k < model.links.size(); ++k) {
    const ArmLink& link = model.links[k];
    if (k > joint) reach += origin(link.X_PJ).norm();
    const double lever = turns ? reach + link.p_LC.norm() : 1.0;
    weight += link.mass * g * lever;
    inertia += link.mass * lever * lever + (turns ? link.I_C_L.norm() : 0.0);
  }
  return std::clamp(2.0 * weight + 50.0 * inertia, turns ? 200.0 : 1000.0, 1e6);
}

std::vector<double> effort_bounds(const ArmModel& model) {
  std::vector<double> bounds;
  for (std::size_t i = 0; i < model.links.size(); ++i) bounds.push_back(effort_bound(model, i));
  return bounds;
}

ArmInertia::ArmInertia(const ArmModel& model)
    : model_(model), drawn_(Jacobian::Zero(6, size())), given_(size(), size()) {
  M_.setZero(size(), size());
  next_ = M_;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    nominal_.push_back(0.01 * effort_bound(model, i));
  }
}

bool ArmInertia::update(const ArmKinematics& kinematics) noexcept {
  const bool is_given =
      kinematics.mass_matrix(given_) && given_.rows() == size() && given_.cols() == size();
  if (is_given) {
    std::copy(given_.data(), given_.data() + given_.size(), next_.data());
  } else {
    next_.setZero(size(), size());
    add_links(kinematics);
  }
  if (!follows()) return false;
  int missing = -1;
  for (Eigen::Index i = size() - 1; i >= 0; --i) {
    if (next_.coeff(i, i) > 1e-9) continue;
    missing = static_cast<int>(i);
    next_.coeffRef(i, i) = nominal_[static_cast<std::size_t>(i)];
  }
  missing_ = missing;
  if (!is_sound()) return false;
  M_ = next_;
  is_known_ = true;
  return true;
}

void ArmInertia::momenta(std::span<const double> v, Vector& out) const noexcept {
  out.resize(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < size(); ++k)
      sum += M_.coeff(i, k) * v[static_cast<std::size_t>(k)];
    out.coeffRef(i) = sum;
  }
}

Eigen::Index ArmInertia::size() const noexcept {
  return static_cast<Eigen::Index>(model_.links.size());
}

bool ArmInertia::follows() const noexcept {
  for (Eigen::Index i = 0; is_known_ && i < size(); ++i) {
    const double own = next_.coeff(i, i);
    const double last = M_.coeff(i, i);
    const double least = 0.1 * nominal_[static_cast<std::size_t>(i)];
    if (!(own <= 4.0 * std::max(last, least))) return false;
    if (last > least && !(own >= 0.25 * last)) return false;
  }
  return true;
}

bool ArmInertia::is_sound() noexcept {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double own = next_.coeff(i, i);
    for (Eigen::Index k = 0; k < i; ++k) {
      const double most = std::sqrt(own * next_.coeff(k, k));
      if (!(std::abs(next_.coeff(i, k) - next_.coeff(k, i)) <= 1e-6 * most)) return false;
    }
  }
  // A direction without mass is let through: joints in line may have one.
  return factored_.factor(size(), [this](Eigen::Index k) {
    return next_.data()[k] * (k % (size() + 1) == 0 ? 1.0 + 1e-6 : 1.0);
  });
}

void ArmInertia::add_links(const ArmKinematics& kinematics) noexcept {
  for (Eigen::Index k = 0; k < size(); ++k) {
    const ArmLink& link = model_.links[static_cast<std::size_t>(k)];
    if (link.mass > 0.0 || !link.I_C_L.isZero(0.0)) add(kinematics, link, static_cast<int>(k));
  }
  for (Eigen::Index i = 0; i < size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    next_.coeffRef(i, i) += model_.links[joint].rotor_inertia;
    for (Eigen::Index k = 0; k < i; ++k) next_.coeffRef(i, k) = next_.coeff(k, i);
  }
}

void ArmInertia::add(const ArmKinematics& kinematics, const ArmLink& link, int index) noexcept {
  const Pose X_WL = kinematics.X_WL(index);
  kinematics.jacobian(index, X_WL * link.p_LC, drawn_);
  const Mat3 R_WL = rotation(X_WL);
  const Mat3 I_W = R_WL * link.I_C_L * transposed(R_WL);
  double* row = next_.data();
  for (Eigen::Index i = 0; i <= index; ++i, row += size()) {
    const Twist column = column_of(drawn_, i);
    const Wrench inertial{link.mass * column.linear, I_W * column.angular};
    for (Eigen::Index k = 0; k <= i; ++k) row[k] += power(inertial, column_of(drawn_, k));
  }
}

}  // namespace repel
