// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/kinematics_watch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/loop/arms/arm_bodies.hpp>

namespace repel {

KinematicsWatch::KinematicsWatch(std::vector<double> efforts)
    : efforts_(std::move(efforts)),
      q_(efforts_.size()),
      J_(Jacobian::Zero(6, static_cast<Eigen::Index>(efforts_.size()))),
      gravity_(q_),
      gravity_q_(q_) {}

bool KinematicsWatch::agrees(std::span<const double> q, const Pose& X_WT,
                             const Jacobian& J) const noexcept {
  double largest = 1.0;  // [m/rad] or 1
  for (Eigen::Index k = 0; k < J.size(); ++k) {
    if (!(std::abs(J.data()[k]) <= most_entry)) return false;  // NaN as well
    if (is_known_) largest = std::max(largest, std::abs(J_.data()[k]));
  }
  if (!is_known_) return true;
  Twist way;            // by the mean of both Jacobians
  double turned = 0.0;  // [rad] and [m], of all joints together
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double d = q[i] - q_[i];
    const auto joint = static_cast<Eigen::Index>(i);
    const Twist now = column_of(J, joint);
    const Twist then = column_of(J_, joint);
    way.linear += 0.5 * d * (now.linear + then.linear);
    way.angular += 0.5 * d * (now.angular + then.angular);
    turned += std::abs(d);
  }
  if (turned > far) return true;  // nothing to compare with
  const double bend = 2.0 * largest * turned;
  for (Eigen::Index k = 0; k < J.size(); ++k) {
    if (!(std::abs(J.data()[k] - J_.data()[k]) <= jacobian_noise + bend)) return false;
  }
  const double curve = largest * turned * turned * turned;
  const Vec3 moved = origin(X_WT) - origin(X_WT_);
  const Mat3 R = rotation(X_WT) * transposed(rotation(X_WT_));
  const Vec3 spun(0.5 * (R(2, 1) - R(1, 2)), 0.5 * (R(0, 2) - R(2, 0)), 0.5 * (R(1, 0) - R(0, 1)));
  return norm(Vec3(moved - way.linear)) <= pose_noise + share * norm(way.linear) + curve &&
         norm(Vec3(spun - way.angular)) <= pose_noise + share * norm(way.angular) + curve;
}

void KinematicsWatch::keep(std::span<const double> q, const Pose& X_WT,
                           const Jacobian& J) noexcept {
  if (is_known_ && way_to(q, q_) < apart) return;
  std::copy(q.begin(), q.end(), q_.begin());
  X_WT_ = X_WT;
  std::copy(J.data(), J.data() + J.size(), J_.data());  // an assignment might resize
  is_known_ = true;
}

bool KinematicsWatch::believe(std::span<const double> q, std::span<double> gravity) noexcept {
  const double turned = has_gravity_ ? way_to(q, gravity_q_) : far;
  bool is_sound = true;
  for (std::size_t i = 0; i < gravity.size(); ++i) {
    const double jump = std::abs(gravity[i] - gravity_[i]);
    const bool follows = turned >= far || jump <= (0.05 + 2.0 * turned) * efforts_[i];
    is_sound = is_sound && follows && std::abs(gravity[i]) <= 2.0 * efforts_[i];
  }
  if (!is_sound) {
    std::copy(gravity_.begin(), gravity_.end(), gravity.begin());
    return false;
  }
  std::copy(gravity.begin(), gravity.end(), gravity_.begin());
  std::copy(q.begin(), q.end(), gravity_q_.begin());
  has_gravity_ = true;
  return true;
}

double KinematicsWatch::way_to(std::span<const double> q,
                               const std::vector<double>& from) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) sum += std::abs(q[i] - from[i]);
  return sum;
}

}  // namespace repel
