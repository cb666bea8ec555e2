// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts the system calls of the tick. The count must be zero.
#pragma once

#include <cstdint>

namespace repel::runs {

/// System calls allowed in a watched thread, to yield or sleep. They are not counted.
enum class Pauses {
  none,    ///< for a tick in real time
  yields,  ///< sched_yield: in lock step, threads may outnumber the processors
  naps     ///< also clock_nanosleep: for threads that only run ticks and sleep in between
};

/// While an instance exists, its thread is watched up to its first system call, so a guarded
/// section counts at most one. Linux passes the call to a signal handler (Syscall User Dispatch);
/// that counts it and lets it run. Functions of the C library without the kernel (vDSO: the clock,
/// on most machines) are no system calls. Cost: two stores of a byte.
class SystemCallGuard {
 public:
  SystemCallGuard() noexcept;
  ~SystemCallGuard();
  SystemCallGuard(const SystemCallGuard&) = delete;
  SystemCallGuard& operator=(const SystemCallGuard&) = delete;

  /// Prepares the calling thread; required before its first guard. May allocate.
  static void arm(Pauses allowed) noexcept;
  /// Watches the calling thread from here to its end or its first forbidden system call; for
  /// threads running ticks only.
  static void watch_this_thread() noexcept;
  /// System calls counted in the whole program; -1 where they could not be counted: no Linux 5.11
  /// on x86-64, a sanitizer with its own system calls, or a thread without arm().
  [[nodiscard]] static std::int64_t calls() noexcept;
};

}  // namespace repel::runs
