// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Describes the machine of a run and requests real-time scheduling from it.
#pragma once

#include <string>
#include <vector>

namespace repel::host {

/// Real-time scheduling granted by the system to a thread.
struct Grant {
  int priority = 0;  ///< SCHED_FIFO priority; 0: refused
  bool memory_locked = false;
  bool kept_awake = false;  ///< idle processors stay out of deep sleep states
};

struct Machine {
  std::string cpu;
  std::string kernel;
  std::string scheduler;  ///< as to_text(Grant): "SCHED_FIFO 80, memory locked" or what was refused
  std::string compiler;
  std::string instruction_set;  ///< in use (repel/schedule/instruction_set.hpp)
  std::string commit;
};

/// Requests a real-time priority for the calling thread, and for the program locked memory and no
/// deep processor sleep states. Each may be refused.
[[nodiscard]] Grant request_real_time() noexcept;

/// Requests a real-time priority one below that of request_real_time, for helper threads. Returns
/// the priority; 0: refused.
int follow_real_time() noexcept;

/// The processors on which the calling thread may run, at least one.
[[nodiscard]] std::vector<int> allowed_processors();

/// Binds the calling thread to these processors; returns false if refused.
[[nodiscard]] bool run_on(const std::vector<int>& processors) noexcept;

/// Moves all other threads of this program that have no real-time priority off the calling thread's
/// processor, if there is another one: running there, they would evict its caches. Takes
/// milliseconds.
void clear_own_processor();

/// What was granted, as text.
[[nodiscard]] std::string to_text(const Grant& grant);

/// @param scheduler what was granted, as text
[[nodiscard]] Machine describe_machine(const std::string& scheduler);

}  // namespace repel::host
