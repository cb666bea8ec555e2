/// @file
/// How light an arm can appear to its network.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/network/elements/dense.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/machinery/prediction.hpp>

namespace repel {

namespace detail {

/// Number `index` of the van der Corput sequence of this base, 0 to 1: its digits behind the point,
/// in reverse. One sequence for each joint, of different primes, fills the workspace evenly (J. H.
/// Halton, 1960), and equally on every machine.
[[nodiscard]] constexpr double van_der_corput(int index, int base) noexcept {
  double sum = 0.0;
  double share = 1.0;
  for (; index > 0; index /= base) {
    share /= base;
    sum += share * (index % base);
  }
  return sum;
}

/// Pose `index` of the workspace; joints that turn without end, or slide so, within 3.14 rad or
/// 1 m of the start.
inline void place_joints(const ArmDescription& arm, int index, std::vector<double>& q) {
  constexpr int primes[network::most_joints] = {2,  3,  5,  7,  11, 13, 17, 19,
                                                23, 29, 31, 37, 41, 43, 47, 53};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const ArmLink& link = arm.model.links[i];
    const double reach = link.type == JointType::revolute ? std::numbers::pi : 1.0;
    const double lower = std::isfinite(link.lower) ? link.lower : arm.start[i] - reach;
    const double upper = std::isfinite(link.upper) ? link.upper : arm.start[i] + reach;
    q[i] = lower + (upper - lower) * van_der_corput(index, primes[i]);
  }
}

/// The greatest eigenvalue of three rows and columns of J M^-1 J', from `row` on: 1 / the least
/// mass or inertia over all directions.
[[nodiscard]] inline double mobility(const Jacobian& J, const ArmInertia::Matrix& inverse,
                                     Eigen::Index row) noexcept {
  double A[3][3] = {};
  for (Eigen::Index k = 0; k < J.cols(); ++k) {
    for (Eigen::Index l = 0; l < J.cols(); ++l) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          A[i][j] += J.coeff(row + i, k) * inverse.coeff(k, l) * J.coeff(row + j, l);
        }
      }
    }
  }
  return greatest_eigenvalue(A);
}

}  // namespace detail

/// The least masses of an arm at its start and in 63 poses of its workspace, the same in every run,
/// divided by the uncertainty of its masses; and how late it answers. Leaves the kinematics at the
/// start. Set-up only. Cost: 64 mass matrices.
/// @param period [s]
[[nodiscard]] inline network::RobotEnd robot_end(const ArmDescription& arm, double period) {
  constexpr int poses = 64;
  const auto size = static_cast<Eigen::Index>(arm.model.links.size());
  ArmInertia inertia(arm.model);
  Jacobian J(6, size);
  std::vector<double> q = arm.start;
  double tool = 0.0, turning = 0.0;  // greatest mobilities [1/kg], [1/(kg m^2)]
  network::Vec<network::any_size> joints;
  joints.setZero(size);
  for (int pose = 0; pose < poses; ++pose) {
    if (pose > 0) detail::place_joints(arm, pose, q);
    arm.kinematics->update(q);
    arm.kinematics->tool_jacobian(J);
    inertia.update(*arm.kinematics);
    ArmInertia::Matrix inverse = inertia.matrix();
    if (!network::dense::invert_positive(inverse.data(), size)) continue;
    tool = std::max(tool, detail::mobility(J, inverse, 0));
    turning = std::max(turning, detail::mobility(J, inverse, 3));
    for (Eigen::Index i = 0; i < size; ++i) {
      joints.coeffRef(i) = std::max(joints.coeff(i), inverse.coeff(i, i));
    }
  }
  arm.kinematics->update(arm.start);
  const double share = 1.0 / arm.options.joints.mass_uncertainty;
  const auto least = [&](double mobility) { return mobility > 0.0 ? share / mobility : 0.0; };
  const double delay = arm.options.drive_delay;
  network::RobotEnd robot{.mass = least(tool), .inertia = least(turning)};
  robot.joints.setZero(size);
  for (Eigen::Index i = 0; i < size; ++i) robot.joints.coeffRef(i) = least(joints.coeff(i));
  robot.speed = arm.options.tool_speed;
  robot.response = network::Prediction::horizon(delay) * period;
  robot.wall_ticks = wall_ticks(delay);
  return robot;
}

}  // namespace repel
