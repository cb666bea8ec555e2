/// @file
/// The machine a run happened on, and what it grants a real-time program.
#pragma once

#include <string>
#include <vector>

namespace repel::host {

/// What a thread that asked for real time was granted.
struct Grant {
  int priority = 0;  ///< of SCHED_FIFO; 0: refused
  bool memory_locked = false;
  bool kept_awake = false;  ///< idle processors do not sleep deeply
};

struct Machine {
  std::string cpu;
  std::string kernel;
  std::string scheduler;  ///< what was granted: "SCHED_FIFO 80, memory locked" or what was refused
  std::string compiler;
  std::string commit;
};

/// Asks for a real-time priority for the calling thread, and for locked memory and waking
/// processors for the program, each of which may be refused.
[[nodiscard]] Grant request_real_time() noexcept;

/// Asks for the real-time priority one below the caller of request_real_time, for threads that
/// serve it. Returns the priority; 0: refused.
int follow_real_time() noexcept;

/// The processors the calling thread may run on, at least one.
[[nodiscard]] std::vector<int> allowed_processors();

/// Binds the calling thread to these; false where that is refused.
[[nodiscard]] bool run_on(const std::vector<int>& processors) noexcept;

/// Moves the threads of this program that have no real-time priority off the processor that the
/// calling thread is on, where there is another: what they do there would cost it its caches. Takes
/// milliseconds.
void clear_own_processor();

/// What was granted, in words.
[[nodiscard]] std::string to_text(const Grant& grant);

/// @param scheduler what was granted, in words
[[nodiscard]] Machine describe_machine(const std::string& scheduler);

}  // namespace repel::host
