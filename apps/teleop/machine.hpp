/// @file
/// The machine a run happened on, and what it grants a real-time program.
#pragma once

#include <string>

namespace repel::teleop {

struct Machine {
  std::string cpu;
  std::string kernel;
  std::string scheduler;  ///< what was granted: "SCHED_FIFO 80, memory locked" or what was refused
  std::string compiler;
  std::string commit;
};

/// Asks for a real-time priority, locked memory and waking processors, each of which may be
/// refused. Returns what was granted, in words.
[[nodiscard]] std::string request_real_time();

/// Gives the calling thread the real-time priority one below the caller of request_real_time, if
/// the machine grants it. For coprocessor threads.
void follow_real_time(int index) noexcept;

/// @param scheduler what request_real_time returned
[[nodiscard]] Machine describe_machine(const std::string& scheduler);

}  // namespace repel::teleop
