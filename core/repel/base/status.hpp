/// @file
/// What went wrong during a tick, as bits. Every bit says what was done about it and what to mend.
#pragma once

#include <cstdint>
#include <string>

namespace repel {

/// The sum of what a tick noticed; 0 is a clean tick.
using Status = std::uint32_t;

namespace status {
inline constexpr Status bad_pose = 1U << 0;  ///< a pose was not finite or not rigid: the last good
                                             ///< one was kept and the force ramps to zero
inline constexpr Status bad_command = 1U << 1;  ///< the operator's input was not finite: taken as
                                                ///< rest, the force ramps to zero
inline constexpr Status bad_joints = 1U
                                     << 2;  ///< the arm reported joints that are not finite: the
                                            ///< last good ones were kept, the force ramps to zero
inline constexpr Status clock_fault = 1U << 3;  ///< the clock stood still or ran back: the force
                                                ///< ramps to zero
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
inline constexpr Status expired_pairs = 1U << 8;  ///< some answer was older than Budget::max_age:
                                                  ///< nothing is known of what is near, the force
                                                  ///< ramps to zero; raise the budget or threads
inline constexpr Status silent_device = 1U << 9;  ///< a master has not answered for too long: its
                                                  ///< last sample stands, the force ramps to zero
inline constexpr Status saturated = 1U << 10;     ///< a master, its motor or a coupling was at its
                                               ///< limit: the operator asks for more than there is
inline constexpr Status joint_limit = 1U << 11;  ///< a joint was pushed back from the end of its
                                                 ///< range: lead the arm another way
inline constexpr Status network_fault = 1U
                                        << 12;  ///< the network could not be solved: the torques of
                                                ///< the tick before stand, the force ramps to zero
inline constexpr Status speed_limit = 1U << 13;  ///< a joint was as fast as it may be and was not
                                                 ///< driven on: lead the arm more slowly, or away
                                                 ///< from a singularity
inline constexpr Status failsafe = bad_pose | bad_command | bad_joints | clock_fault |
                                   expired_pairs | silent_device | network_fault;
}  // namespace status

/// The names of the bits that are set, comma by comma; "ok" when none is. Not for the tick.
[[nodiscard]] inline std::string to_text(Status bits) {
  static constexpr const char* names[] = {
      "bad_pose",    "bad_command",  "bad_joints",    "clock_fault",   "stale_pairs",
      "late_result", "torque_limit", "crowded_pairs", "expired_pairs", "silent_device",
      "saturated",   "joint_limit",  "network_fault", "speed_limit"};
  std::string text;
  for (unsigned i = 0; i < 14; ++i) {
    if ((bits >> i & 1U) != 0U) text += (text.empty() ? "" : ", ") + std::string(names[i]);
  }
  return text.empty() ? "ok" : text;
}

}  // namespace repel
