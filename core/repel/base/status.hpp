/// @file
/// What went wrong during a tick, as bits. Every bit says what was done about it and what to mend.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>

namespace repel {

/// The sum of what a tick noticed; 0 is a clean tick.
using Status = std::uint32_t;

namespace status {
inline constexpr Status bad_pose = 1U << 0;  ///< a pose was not finite or not rigid: the last good
                                             ///< one was kept and the arm brakes
inline constexpr Status bad_command = 1U << 1;  ///< the operator's input was not finite: taken as
                                                ///< rest, the operator is let go
inline constexpr Status bad_joints = 1U << 2;  ///< the arm reported joints that are not finite: the
                                               ///< motion is predicted, the arm brakes
inline constexpr Status clock_fault = 1U << 3;  ///< the clock stood still or ran back: the operator
                                                ///< is let go
inline constexpr Status stale_pairs = 1U << 4;  ///< some near pairs kept an old answer, widened by
                                                ///< the motion since: raise the budget or threads
inline constexpr Status late_result = 1U
                                      << 5;  ///< a worker of the coprocessor did not answer in
                                             ///< time: the caller did its work; if it lasts, free
                                             ///< a processor for each thread or lower the rate
inline constexpr Status torque_limit = 1U << 6;   ///< a joint torque was cut to its limit
inline constexpr Status crowded_pairs = 1U << 7;  ///< more pairs could come within range than
                                                  ///< there is memory for: the rest was evaluated
                                                  ///< from a cold start; raise Limits::candidates
inline constexpr Status expired_pairs = 1U
                                        << 8;  ///< some answer was older than Budget::max_age:
                                               ///< nothing is known of what is near, the operator
                                               ///< is let go; raise the budget or threads
inline constexpr Status silent_device = 1U << 9;  ///< a master has not answered for too long: its
                                                  ///< last sample stands, the operator is let go
inline constexpr Status saturated = 1U << 10;     ///< a master, its motor or a coupling was at its
                                               ///< limit: the operator asks for more than there is
inline constexpr Status joint_limit = 1U << 11;  ///< a joint was pushed back from the end of its
                                                 ///< range: lead the arm another way
inline constexpr Status network_fault = 1U
                                        << 12;  ///< the network could not be solved: the torques of
                                                ///< the tick before stand, the operator is let go
inline constexpr Status speed_limit = 1U << 13;  ///< a joint was as fast as it may be and was not
                                                 ///< driven on: lead the arm more slowly, or away
                                                 ///< from a singularity
inline constexpr Status implausible_joints =
    1U << 14;  ///< joints and rates as reported cannot both be true, nor follow from the torques
               ///< sent: the motion is predicted, the arm brakes; mend cable, encoder or driver
inline constexpr Status frozen_joints =
    1U << 15;  ///< a joint reports the same numbers although it moves or must move: the motion is
               ///< predicted, the arm brakes; mend cable, encoder or driver
inline constexpr Status clock_gap = 1U << 16;  ///< the loop stood still for longer than
                                               ///< TeleoperatorOptions::longest_gap: the operator
                                               ///< is let go; free a processor for the loop
inline constexpr Status bad_torque =
    1U << 17;  ///< a torque came out as no finite number: what holds the arm against gravity was
               ///< sent in its place and all memories begin anew
inline constexpr Status torque_rate = 1U << 18;  ///< a torque was kept from changing faster than
                                                 ///< TeleoperatorOptions::slew_time allows
inline constexpr Status tool_speed = 1U << 19;   ///< the tool was as fast as it may be and was not
                                                 ///< driven on: lead it more slowly
inline constexpr Status arm_stopped = 1U << 20;  ///< the arm is not enabled, or stopped by itself:
                                                 ///< see its own messages
inline constexpr Status pushed_out = 1U << 21;   ///< the run began inside an obstacle: the arm is
                                                 ///< pushed out slowly and nobody leads it

/// Faults of joint sensing: where the arm is now is not known.
inline constexpr Status blind = bad_joints | implausible_joints | frozen_joints;
/// What takes the operator's force away.
inline constexpr Status failsafe = bad_pose | bad_command | clock_fault | expired_pairs |
                                   silent_device | network_fault | clock_gap | bad_torque |
                                   arm_stopped | pushed_out | blind;
}  // namespace status

/// What the loop does about faults, named after the stop categories of machine safety.
enum class Stop : std::uint8_t {
  running,   ///< no fault: the operator leads the arm
  holding,   ///< what the operator gives is gone; walls, limits and a damping that brakes stay
  braking,   ///< the joints are not trusted: the last motion is predicted and braked, then the
             ///< brakes of the arm are asked for
  released,  ///< nothing can be trusted: no torque but what holds the last pose known against
             ///< gravity, and none at all where the brakes of the arm hold it
};

/// Its name. Not for the tick.
[[nodiscard]] inline std::string to_text(Stop stop) {
  static constexpr const char* names[] = {"running", "holding", "braking", "released"};
  return names[static_cast<std::size_t>(stop)];
}

/// The names of the bits that are set, comma by comma; "ok" when none is. Not for the tick.
[[nodiscard]] inline std::string to_text(Status bits) {
  static constexpr const char* names[] = {
      "bad_pose",      "bad_command",  "bad_joints",    "clock_fault",   "stale_pairs",
      "late_result",   "torque_limit", "crowded_pairs", "expired_pairs", "silent_device",
      "saturated",     "joint_limit",  "network_fault", "speed_limit",   "implausible_joints",
      "frozen_joints", "clock_gap",    "bad_torque",    "torque_rate",   "tool_speed",
      "arm_stopped",   "pushed_out"};
  std::string text;
  for (unsigned i = 0; i < std::size(names); ++i) {
    if ((bits >> i & 1U) != 0U) text += (text.empty() ? "" : ", ") + std::string(names[i]);
  }
  return text.empty() ? "ok" : text;
}

}  // namespace repel
