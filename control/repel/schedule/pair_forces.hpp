// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results of an exchange of the coprocessor: forces and totals of the pairs, and the state of
/// its threads.
#pragma once

#include <cstdint>

namespace repel {

/// What the caller knows of the threads at a tick; all zero without threads.
struct WorkerReport {
  int stood_in = 0;                  ///< 1 while a thread is late and the caller does its work
  std::int64_t silence = 0;          ///< [ticks] for how long that has been so
  std::int64_t ticks = 0;            ///< number of ticks since set-up of which it was so
  std::int64_t longest_silence = 0;  ///< [ticks] largest `silence` since set-up
  std::int64_t age = 0;              ///< [ticks] of the answer used; only beside it is not 0
  std::int64_t oldest_age = 0;       ///< [ticks] largest `age` since set-up
  std::int64_t shared = 0;           ///< number of ticks since set-up with work for the threads

  /// Counts a tick. @param late the caller did the work of a thread
  void count(bool late) noexcept;
};

/// What the operating system has done to the threads since set-up, and how many were replaced.
struct WorkerUsage {
  std::int64_t page_faults = 0;  ///< minor and major
  std::int64_t switches = 0;     ///< a thread was taken off its processor while it had work to do
  std::int64_t restarts = 0;     ///< threads started in place of one that did not go on
};

}  // namespace repel
