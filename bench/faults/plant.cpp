// SPDX-License-Identifier: BSD-3-Clause
#include "plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include <repel/simulated/brake_torque.hpp>

namespace repel::faults {

Plant::Plant(ArmModel model)
    : model_(std::move(model)),
      dynamics_(model_),
      q_(model_.links.size()),
      v_(q_),
      bias_(q_),
      M_(q_.size(), q_.size()),
      held_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(q_.size()))) {}

void Plant::reset(std::span<const double> q) {
  q_.assign(q.begin(), q.end());
  std::fill(v_.begin(), v_.end(), 0.0);
  held_.setZero();
}

void Plant::step(double period, std::span<const DriveOfJoint> drive, bool braked) {
  const auto n = static_cast<Eigen::Index>(q_.size());
  const double h = period / substeps;
  dynamics_.inertia(q_, M_);
  dynamics_.bias(q_, v_, bias_);
  Eigen::VectorXd push(n);
  Eigen::VectorXd most(n);  // [N m s] that dry friction and brake can take in a substep
  Eigen::MatrixXd implicit = M_;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const ArmLink& link = model_.links[joint];
    const DriveOfJoint& d = drive[joint];
    const double limit = link.effort_limit;
    const double torque = std::isfinite(d.torque) ? std::clamp(d.torque, -limit, limit) : 0.0;
    push[i] = h * ((braked ? 0.0 : torque) - bias_[joint]);
    const double share = braked ? d.brake_holds : d.brake_drags;
    most[i] = h * (link.coulomb_friction + share * brake_torque(model_, static_cast<int>(i)));
    implicit(i, i) += h * link.viscous_friction;
  }
  mobility_ = implicit.inverse();
  Eigen::Map<Eigen::VectorXd> v(v_.data(), n);
  for (int k = 0; k < substeps; ++k) {
    held_ = held_.cwiseMax(-most).cwiseMin(most);
    v = mobility_ * (M_ * v + push + held_).eval();
    for (int sweep = 0; sweep < 12; ++sweep) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const double next = std::clamp(held_[i] - v[i] / mobility_(i, i), -most[i], most[i]);
        v += (next - held_[i]) * mobility_.col(i);
        held_[i] = next;
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      // What friction holds is at rest to the last bit, as an encoder sees it.
      if (std::abs(held_[i]) < most[i] && std::abs(v[i]) < 1e-6) v[i] = 0.0;
      q_[static_cast<std::size_t>(i)] += h * v[i];
    }
  }
}

std::vector<Pose> Truth::links(std::span<const double> q) const {
  std::vector<Pose> poses;
  Pose X = model_.X_WB;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const ArmLink& link = model_.links[i];
    X = X * link.X_PJ;
    if (link.type == JointType::prismatic) {
      X.translate(Vec3(q[i] * link.axis_J));
    } else {
      X.rotate(Eigen::AngleAxisd(q[i], link.axis_J));
    }
    poses.push_back(X);
  }
  return poses;
}

double Truth::gap(std::span<const double> q) const {
  const std::vector<Pose> poses = links(q);
  double least = std::numeric_limits<double>::infinity();
  for (const Points& part : parts_) {
    const Pose X_BL = X_BW_ * poses[static_cast<std::size_t>(part.link)];
    for (const Vec3& p : part.p_LP) {
      const Eigen::Array3d beyond = (X_BL * p).array().abs() - half_.array();
      const double outside = beyond.max(0.0).matrix().norm();
      const double inside = std::min(0.0, beyond.maxCoeff());
      const double distance = outside + inside - part.radius;
      if (!(distance >= least)) least = distance;
      if (std::isnan(least)) return -std::numeric_limits<double>::infinity();  // it flew apart
    }
  }
  return least;
}

Vec3 Truth::tool(std::span<const double> q) const {
  return (links(q).back() * model_.X_LT).translation();
}

}  // namespace repel::faults
