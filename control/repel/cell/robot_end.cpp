// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/robot_end.hpp>

#include <algorithm>
#include <vector>

#include <repel/cell/workspace.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/network/machinery/prediction.hpp>
#include <repel/network/modules/force_sensor.hpp>

namespace repel::detail {

double mobility(const Jacobian& J, const ArmInertia::Matrix& inverse, Eigen::Index row) noexcept {
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

}  // namespace repel::detail

namespace repel {

void require_fitting_sensor(const ArmDescription& arm, const network::Network& network) {
  if (!arm.takes_motion || network.find<network::ForceSensor>() == nullptr) return;
  throw SetupError(
      "network: a force_sensor makes an arm lighter that takes torques; this one takes rates or "
      "positions; allowed: none");
}

network::RobotEnd robot_end(const ArmDescription& arm, double period) {
  constexpr int poses = 64;
  const auto size = static_cast<Eigen::Index>(arm.model.links.size());
  ArmInertia inertia(arm.model);
  Jacobian J(6, size);
  std::vector<double> q = arm.start;
  double tool = 0.0, turning = 0.0;  // greatest mobilities [1/kg], [1/(kg m^2)]
  network::Vec<network::any_size> joints;
  joints.setZero(size);
  for (int pose = 0; pose < poses; ++pose) {
    if (pose > 0) detail::draw_pose(arm, pose, q);
    arm.kinematics->update(q);
    arm.kinematics->tool_jacobian(J);
    inertia.begin_anew();
    if (!inertia.update(*arm.kinematics)) continue;
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
