/// @file
/// Options of the loop: reactions to faults, and speed limits.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/loop/energy_watch.hpp>
#include <repel/loop/failsafe.hpp>
#include <repel/loop/joint_torques.hpp>
#include <repel/loop/joint_watch.hpp>
#include <repel/loop/stop_control.hpp>

namespace repel {

struct TeleoperatorOptions {
  double tool_speed = 0.25;  ///< [m/s] up to which the operator may drive the tool; above it the
                             ///< driving power fades, from 1.2 times it the arm brakes; 1e-3 to 10
  double longest_gap = 0.1;  ///< [s] without a tick after which the operator's force is removed
  double exit_speed = 0.02;  ///< [m/s] at which an arm is pushed out of an obstacle it starts in
  bool push_out = false;     ///< the arm starts inside an obstacle and is to be pushed out of it
  /// The drive of the arm engages its brakes where TickRecord::brakes says so. Without brakes the
  /// motors hold the weight for as long as a pose is known.
  bool has_brakes = false;
  double drive_delay = 0.0;  ///< [ticks] from a torque to its effect, beyond its being held for one
                             ///< tick; 0 to 10: the longer, the softer the arm follows
  bool prediction = true;    ///< false: the network is solved for the measured rates, without the
                             ///< mass of the arm, to compare with
  EnergyWatchOptions energy;
  FailsafeOptions failsafe;
  StopOptions stop;
  JointTorqueOptions torques;
  JointWatchOptions joints;
};

/// Returns `options`. @throws SetupError naming the one that is out of range
[[nodiscard]] inline const TeleoperatorOptions& checked(const TeleoperatorOptions& options) {
  checked("tool speed", options.tool_speed, 1e-3, 10.0, "m/s");
  checked("longest gap", options.longest_gap, 0.0, 1e6, "s");
  checked("drive delay", options.drive_delay, 0.0, 10.0, "ticks");
  checked("exit speed", options.exit_speed, 0.0, 10.0, "m/s");
  return options;
}

}  // namespace repel
