// SPDX-License-Identifier: BSD-3-Clause
// An arm with a torque callback of 1 kHz, driven into a wall that exists only in the model.
#include <cstdio>
#include <vector>

#include "torque_callback.hpp"

using namespace repel;

int main() {
  franka::Robot robot("192.0.2.1");  // the address of yours
  const franka::Model model = robot.loadModel();
  CellDescription cell;
  cell.arms.emplace_back().parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(0.55, 0.0, 0.5));
  cell.obstacles.push_back({"wall", Shape::box({0.1, 0.5, 0.5}), X_WP});
  try {
    adapters::TorqueCallback callback(model, robot.readOnce(), std::move(cell));
    struct Line {
      double time, gap, force;
    };
    std::vector<Line> lines;
    lines.reserve(10);
    network::HandInput hand;
    hand.ball.linear = {0.1, 0.0, 0.0};  // 100 mm/s towards the wall
    const auto control = [&](const franka::RobotState& state, franka::Duration period) {
      callback.lead(hand);  // a thread of your own does this
      const franka::Torques torques = callback(state, period);
      const TickRecord& tick = *callback.record();
      if (tick.tick % 500 == 0 && tick.pairs.near > 0 && lines.size() < lines.capacity()) {
        lines.push_back({tick.time, tick.pairs.nearest, tick.virtual_force.force.norm()});
      }
      if (tick.time > 4.0) callback.finish();
      return torques;
    };
    robot.control(control, true, franka::kMaxCutoffFrequency);
    for (const Line& line : lines) {
      std::printf("%.1f s: %5.1f mm from the wall, %4.1f N\n", line.time, 1e3 * line.gap,
                  line.force);
    }
  } catch (const std::exception& e) {  // SetupError, Stopped, those of libfranka
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
