/// @file
/// Counts the system calls of the tick. The answer must be nothing.
#pragma once

#include <cstdint>

namespace repel::teleop {

/// System calls by which a watched thread may give way. They are not counted.
enum class Pauses {
  none,    ///< for a tick by the clock
  yields,  ///< sched_yield: in lock step threads may outnumber the processors
  naps     ///< and clock_nanosleep: for a thread that does ticks and sleeps between them
};

/// While one lives, its thread is watched up to its first system call: a section counts one or
/// none. Linux hands the call to a signal handler instead of making it (Syscall User Dispatch); it
/// is then made after all. What the C library answers without the kernel (vDSO: the clock, on most
/// machines) is no system call. Cost: two stores of a byte.
class SystemCallGuard {
 public:
  SystemCallGuard() noexcept;
  ~SystemCallGuard();
  SystemCallGuard(const SystemCallGuard&) = delete;
  SystemCallGuard& operator=(const SystemCallGuard&) = delete;

  /// Makes the calling thread ready: before its first guard. May allocate.
  static void arm(Pauses allowed) noexcept;
  /// Watches the calling thread from here to its end, or to its first system call that is not
  /// allowed; for threads that do nothing but ticks.
  static void watch_this_thread() noexcept;
  /// System calls seen under guard in the whole program; -1 where they could not be counted: no
  /// Linux 5.11 on x86-64, a sanitizer with calls of its own, a thread that was not armed.
  [[nodiscard]] static std::int64_t calls() noexcept;
};

}  // namespace repel::teleop
