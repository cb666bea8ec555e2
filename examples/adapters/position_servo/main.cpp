// SPDX-License-Identifier: BSD-3-Clause
// An arm that takes joint positions at 500 Hz, driven into a wall that exists only in the model.
#include <cstdio>

#include "position_servo.hpp"
#include "ur_arm.hpp"

using namespace repel;

int main() try {
  constexpr double rate = 500.0;      // [Hz]
  const char* address = "192.0.2.2";  // of yours
  ur_rtde::RTDEControlInterface control(address, rate);
  ur_rtde::RTDEReceiveInterface receive(address, rate);
  CellDescription cell;
  cell.rate_hz = rate;
  cell.arms.push_back(adapters::ur5e(receive.getActualQ()));
  cell.arms[0].parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(-0.7, -0.13, 0.5));
  cell.obstacles.push_back({"wall", Shape::box({0.1, 0.5, 0.5}), X_WP});
  const AdmittanceOptions options{.inertia = {2.0, 2.0, 1.0, 0.2, 0.2, 0.2},  // [kg m^2]
                                  .acceleration = 10.0,                       // [rad/s^2]
                                  .response = 0.04};                          // [s] measured
  adapters::PositionServo servo(std::move(cell), options);
  network::HandInput hand;
  hand.ball.linear = {-0.1, 0.0, 0.0};  // 100 mm/s towards the wall
  adapters::run(control, receive, servo, 1.0 / rate, {}, [&](adapters::PositionServo& own) {
    own.lead(hand);  // a thread of your own does this
    const TickRecord& tick = *own.record();
    if (tick.tick % 250 == 0 && tick.pairs.near > 0 && tick.time <= 4.0) {
      std::printf("%.1f s: %5.1f mm from the wall, %4.1f N\n", tick.time, 1e3 * tick.pairs.nearest,
                  tick.virtual_force.force.norm());
    }
    if (tick.time > 4.0) own.finish();
  });
} catch (const std::exception& e) {  // SetupError, ArmStopped, those of ur_rtde
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
