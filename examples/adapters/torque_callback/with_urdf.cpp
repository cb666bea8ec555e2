// SPDX-License-Identifier: BSD-3-Clause
// The same with the arm of the maker's URDF: every link keeps off the obstacles.
#include <cstdio>

#include <franka/robot.h>

#include "franka_urdf.hpp"
#include "torque_callback.hpp"

using namespace repel;

/// @param argv the URDF file for a robot that cannot be asked for it
int main(int argc, char** argv) try {
  const std::string file = argc > 1 ? argv[1] : "fr3.urdf";
  franka::Robot robot("192.0.2.1");  // the address of yours
  const franka::RobotState state = robot.readOnce();
  const UrdfOptions options{.tip = "link8"};  // the flange: in files of your own, fr3_link8
  CellDescription cell;
  cell.arms.push_back(
      adapters::arm_of(parse_arm(adapters::urdf_of(robot, file), options, file), state));
  cell.arms[0].parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(0.55, 0.0, 0.5));
  cell.obstacles.push_back({"wall", Shape::box({0.1, 0.5, 0.5}), X_WP});
  adapters::TorqueCallback callback(state, std::move(cell));
  network::HandInput hand;
  hand.ball.linear = {0.1, 0.0, 0.0};  // 100 mm/s towards the wall
  double gap = 0.0, force = 0.0;
  const auto control = [&](const franka::RobotState& now, franka::Duration period) {
    callback.lead(hand);  // a thread of your own does this
    const franka::Torques torques = callback(now, period);
    const TickRecord& tick = *callback.record();
    if (tick.time > 4.0) {
      callback.finish();
    } else {
      gap = tick.pairs.nearest;
      force = tick.pairs.peak_force;
    }
    return torques;
  };
  robot.control(control, true, franka::kMaxCutoffFrequency);
  std::printf("%.1f mm from the wall, %.1f N\n", 1e3 * gap, force);
} catch (const std::exception& e) {  // SetupError, Stopped, those of libfranka
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
