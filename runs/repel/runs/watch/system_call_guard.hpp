// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts the system calls of the tick. The count must be zero.
#pragma once

#include <cstdint>

namespace repel::runs {

/// System calls that a watched thread may make to yield or sleep. They are not counted.
enum class Pauses {
  none,    ///< for a tick in real time
  yields,  ///< sched_yield: in lock step, threads may outnumber the processors
  naps     ///< also clock_nanosleep: for threads that only run ticks and sleep in between
};

/// While an instance exists, its thread is watched up to its first system call, so a guarded
/// section counts at most one. Linux passes the call to a signal handler (Syscall User Dispatch),
/// which counts it and then lets it run. Functions that the C library answers without the kernel
/// (vDSO: the clock, on most machines) are no system calls. Cost: two stores of a byte.
class SystemCallGuard {
 public:
  SystemCallGuard() noexcept;
  ~SystemCallGuard();
  SystemCallGuard(const SystemCallGuard&) = delete;
  SystemCallGuard& operator=(const SystemCallGuard&) = delete;

  /// Prepares the calling thread; required before its first guard. May allocate.
  static void arm(Pauses allowed) noexcept;
  /// Watches the calling thread from here to its end, or to its first system call that is not
  /// allowed; for threads that only run ticks.
  static void watch_this_thread() noexcept;
  /// System calls counted in the whole program; -1 where they could not be counted: no Linux 5.11
  /// on x86-64, a sanitizer with its own system calls, or a thread without arm().
  [[nodiscard]] static std::int64_t calls() noexcept;
};

}  // namespace repel::runs
