/// @file
/// What the loop does about faults, and how fast the tool may be.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/loop/failsafe.hpp>
#include <repel/loop/joint_torques.hpp>
#include <repel/loop/joint_watch.hpp>
#include <repel/loop/stop_control.hpp>

namespace repel {

struct TeleoperatorOptions {
  double tool_speed = 0.25;  ///< [m/s] at which the operator may lead the tool; beyond it he drives
                             ///< less and less, and from 1.2 times it the arm brakes; 1e-3 to 10
  double longest_gap = 0.1;  ///< [s] without a tick after which the operator is let go
  double exit_speed = 0.02;  ///< [m/s] at which an arm is pushed out of what it starts in
  bool push_out = false;     ///< the arm starts inside an obstacle and is to be pushed out of it
  FailsafeOptions failsafe;
  StopOptions stop;
  JointTorqueOptions torques;
  JointWatchOptions joints;
};

/// `options`, if they are within their ranges. @throws SetupError naming the one that is not
[[nodiscard]] inline const TeleoperatorOptions& checked(const TeleoperatorOptions& options) {
  checked("tool speed", options.tool_speed, 1e-3, 10.0, "m/s");
  checked("longest gap", options.longest_gap, 0.0, 1e6, "s");
  checked("exit speed", options.exit_speed, 0.0, 10.0, "m/s");
  return options;
}

}  // namespace repel
