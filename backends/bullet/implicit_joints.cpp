// SPDX-License-Identifier: BSD-3-Clause
#include "implicit_joints.hpp"

#include <algorithm>
#include <cmath>

#include <repel/simulated/brake_torque.hpp>
#include <repel/simulated/joint_resistance.hpp>

namespace repel::bullet::detail {
namespace {

constexpr int most_sweeps = 100;
constexpr double settled = 1e-14;  // [rad/s] the search ends when no change in a sweep exceeds it

Eigen::VectorXd coulomb_friction_of(const ArmModel& model) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(model.links.size()));
  std::transform(model.links.begin(), model.links.end(), values.begin(),
                 [](const ArmLink& link) { return link.coulomb_friction; });
  return values;
}

Eigen::VectorXd brakes_of(const ArmModel& model) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(model.links.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = brake_torque(model, static_cast<int>(i));
  }
  return values;
}

}  // namespace

ImplicitJoints::ImplicitJoints(const ArmModel& model, const SimulationOptions& options)
    : links_(model.links),
      options_(options),
      coulomb_(coulomb_friction_of(model)),
      brake_(brakes_of(model)),
      diagonal_(coulomb_.size()),
      torque_(coulomb_.size()),
      most_(coulomb_.size()),
      friction_(coulomb_.size()),
      column_(coulomb_.size()),
      factor_(coulomb_.size()) {}

const Eigen::VectorXd& ImplicitJoints::linearize(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                                 std::span<const double> torque,
                                                 double h) noexcept {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const ArmLink& link = links_[static_cast<std::size_t>(i)];
    const auto [damping, stiffness, beyond] = resistance_of(link, options_, q[i], v[i], h);
    diagonal_[i] = link.rotor_inertia + h * damping + h * h * stiffness;
    torque_[i] = torque[static_cast<std::size_t>(i)] - damping * v[i] - stiffness * beyond;
  }
  return torque_;
}

void ImplicitJoints::solve(Eigen::MatrixXd& M_inverse, Eigen::VectorXd& a, const Eigen::VectorXd& v,
                           double h, bool braked, Contacts* contacts) noexcept {
  add_diagonal(M_inverse, a);
  if (contacts != nullptr) contacts->begin(M_inverse, v, h);
  most_ = coulomb_;
  friction_.setZero();
  if (braked) {
    most_ += brake_;
    stand(M_inverse, a, v, h);
  }
  find_friction(M_inverse, a, v, h, contacts);
}

// W = M^-1 and a = M^-1 b become (M + D)^-1 and (M + D)^-1 b, one entry of D after the other
// (Sherman-Morrison): with w the i-th column of W and d the i-th entry of D,
//     a <- a - w d a_i / (1 + d W_ii),      W <- W - w d w^T / (1 + d W_ii).
void ImplicitJoints::add_diagonal(Eigen::MatrixXd& W, Eigen::VectorXd& a) noexcept {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double scale = diagonal_[i] / (1.0 + diagonal_[i] * W(i, i));
    column_ = W.col(i);
    a -= (scale * a[i]) * column_;
    for (Eigen::Index j = 0; j < a.size(); ++j) W.col(j) -= (scale * column_[j]) * column_;
  }
}

// Initial guess: the torques that bring every joint to rest, W f = -(v / h + a), clamped to the
// bounds. If none is clamped, they are the solution; sweeps alone converge slowly where a heavy
// joint carries light ones, and a braked arm would creep.
void ImplicitJoints::stand(const Eigen::MatrixXd& W, Eigen::VectorXd& a, const Eigen::VectorXd& v,
                           double h) noexcept {
  factor_.compute(W);
  if (factor_.info() != Eigen::Success) return;
  friction_ = -(v / h + a);
  factor_.solveInPlace(friction_);
  friction_ = friction_.cwiseMin(most_).cwiseMax(-most_);
  a.noalias() += W * friction_;
}

// The friction torques f are those within +-F that minimize the kinetic energy at the end of the
// sub-step. Projected Gauss-Seidel, one joint at a time: with W = (M + D)^-1, the torque that
// brings v' = v + h a to rest changes f_i by -v'_i / (h W_ii); it is clamped to the bounds. Contact
// forces are updated in the same sweeps.
void ImplicitJoints::find_friction(const Eigen::MatrixXd& W, Eigen::VectorXd& a,
                                   const Eigen::VectorXd& v, double h,
                                   Contacts* contacts) noexcept {
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest_change = 0.0;
    for (Eigen::Index i = 0; i < a.size(); ++i) {
      const double stopping = friction_[i] - (v[i] / h + a[i]) / W(i, i);
      const double change = std::clamp(stopping, -most_[i], most_[i]) - friction_[i];
      friction_[i] += change;
      a += change * W.col(i);
      largest_change = std::max(largest_change, h * std::abs(change) * W(i, i));
    }
    if (contacts != nullptr) largest_change = std::max(largest_change, contacts->sweep(a));
    if (largest_change <= settled) return;
  }
}

}  // namespace repel::bullet::detail
