// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Faults and limits that occurred during a tick, as bits. Each bit states the reaction and the
/// remedy.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>

namespace repel {

/// The bits set by a tick; 0 is a tick without faults.
using Status = std::uint32_t;

namespace status {
/// A pose was not finite or not rigid: the last valid one is kept and the arm brakes
inline constexpr Status bad_pose = 1U << 0;
/// The operator's input was not finite: treated as zero motion, the operator's force is removed
inline constexpr Status bad_command = 1U << 1;
/// The arm reported joints that are not finite: the motion is predicted, the arm brakes
inline constexpr Status bad_joints = 1U << 2;
/// The clock stood still or ran backwards: the operator's force is removed
inline constexpr Status clock_fault = 1U << 3;
/// Some near pairs kept an old result, reduced by the motion since: raise the budget or threads
inline constexpr Status stale_pairs = 1U << 4;
/// A worker of the coprocessor missed its deadline: the caller did its work; if this persists, free
/// a processor for each thread or lower the rate
inline constexpr Status late_result = 1U << 5;
/// A joint torque was clamped to its limit
inline constexpr Status torque_limit = 1U << 6;
/// More pairs could come within range than there is memory for: the others were evaluated from a
/// cold start; raise Capacities::candidates
inline constexpr Status crowded_pairs = 1U << 7;
/// Some result was older than Budget::max_age: nearby obstacles are unknown, the operator's force
/// is removed; raise the budget or threads
inline constexpr Status expired_pairs = 1U << 8;
/// A master device timed out: its last sample is kept, the operator's force is removed
inline constexpr Status silent_device = 1U << 9;
/// A master, its motor or a coupling was at its limit: the operator demands more than is available
inline constexpr Status saturated = 1U << 10;
/// A joint was pushed back from the end of its range: guide the arm another way
inline constexpr Status joint_limit = 1U << 11;
/// The network could not be solved: the torques of the previous tick are kept, the operator's force
/// is removed
inline constexpr Status network_fault = 1U << 12;
/// A joint was at its speed limit and was not driven further: guide the arm more slowly, or away
/// from a singularity
inline constexpr Status speed_limit = 1U << 13;
/// The reported joint angles and rates contradict each other or the torques sent: the motion is
/// predicted, the arm brakes; repair cable, encoder or driver
inline constexpr Status implausible_joints = 1U << 14;
/// A joint reports the same values although it moves or must move: the motion is predicted, the arm
/// brakes; repair cable, encoder or driver
inline constexpr Status frozen_joints = 1U << 15;
/// The loop was suspended for longer than TeleoperatorOptions::longest_gap: the operator's force is
/// removed; free a processor for the loop
inline constexpr Status clock_gap = 1U << 16;
/// A torque was not finite: gravity compensation was sent in its place and all internal states are
/// reset
inline constexpr Status bad_torque = 1U << 17;
/// The rate of change of a torque was limited according to TeleoperatorOptions::slew_time
inline constexpr Status torque_rate = 1U << 18;
/// The tool was at its speed limit and was not driven further: guide it more slowly
inline constexpr Status tool_speed = 1U << 19;
/// The arm is not enabled, or stopped by itself: see its own messages
inline constexpr Status arm_stopped = 1U << 20;
/// The run began inside an obstacle: the arm is pushed out slowly without operator force
inline constexpr Status pushed_out = 1U << 21;
/// The arm gained energy because its torques are held between ticks, more than braking could take
/// back: the operator's force is removed; the mass of the model is not that of the arm, its drive
/// is late, or its readings are: see TeleoperatorOptions::drive_delay
inline constexpr Status energy_gain = 1U << 22;
/// The force sensor gave no sound reading: the arm goes on as without it; repair cable or sensor
inline constexpr Status bad_wrench = 1U << 23;
/// A hard wall cannot be held: it comes faster than the arm can flee, or the arm is too fast for
/// its efforts; it was told before the wall was reached: lower the speed of the obstacle or the arm
inline constexpr Status hold_lost = 1U << 24;
/// At the station of a divided scene: the site is not heard. Its last state is shown, and the
/// master meets a damper; start the site, or repair the link
inline constexpr Status silent_site = 1U << 25;

/// Faults of joint sensing: the present joint positions are unknown.
inline constexpr Status blind = bad_joints | implausible_joints | frozen_joints;
/// Faults that remove the operator's force.
inline constexpr Status failsafe = bad_pose | bad_command | clock_fault | expired_pairs |
                                   silent_device | network_fault | clock_gap | bad_torque |
                                   arm_stopped | pushed_out | energy_gain | blind;
/// The same without the long states of a sound run: a silent operator, and an arm being pushed out
/// of its start position.
inline constexpr Status unsound = failsafe & ~(silent_device | pushed_out);
}  // namespace status

/// Reaction of the loop to faults, named after the stop categories of machine safety.
enum class Stop : std::uint8_t {
  running,   ///< no fault: the operator guides the arm
  holding,   ///< the operator's force is removed; walls, limits and braking damping remain
  braking,   ///< the joint readings are not trusted: the last motion is predicted and braked, then
             ///< the brakes of the arm are requested
  released,  ///< nothing can be trusted: only gravity compensation at the last known pose, and no
             ///< torque at all with brakes on
};

/// Its name. Not real-time safe.
[[nodiscard]] inline std::string to_text(Stop stop) {
  static constexpr const char* names[] = {"running", "holding", "braking", "released"};
  return names[static_cast<std::size_t>(stop)];
}

/// The names of the bits that are set, separated by commas; "ok" when none is. Not real-time safe.
[[nodiscard]] inline std::string to_text(Status bits) {
  static constexpr const char* names[] = {
      "bad_pose",      "bad_command",  "bad_joints",    "clock_fault",   "stale_pairs",
      "late_result",   "torque_limit", "crowded_pairs", "expired_pairs", "silent_device",
      "saturated",     "joint_limit",  "network_fault", "speed_limit",   "implausible_joints",
      "frozen_joints", "clock_gap",    "bad_torque",    "torque_rate",   "tool_speed",
      "arm_stopped",   "pushed_out",   "energy_gain",   "bad_wrench",    "hold_lost",
      "silent_site"};
  std::string text;
  for (unsigned i = 0; i < std::size(names); ++i) {
    if ((bits >> i & 1U) != 0U) text += (text.empty() ? "" : ", ") + std::string(names[i]);
  }
  return text.empty() ? "ok" : text;
}

}  // namespace repel
