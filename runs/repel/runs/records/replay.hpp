// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Support for replays: comparison with the recording, and the clock of the ticks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include <repel/loop/record.hpp>
#include <repel/runs/records/recording.hpp>

namespace repel::runs {

/// How the ticks of a replay compare with the recorded ones.
struct ReplayReport {
  std::int64_t ticks = 0;
  std::int64_t same = 0;               ///< forces and torques of all arms are identical
  std::int64_t first_difference = -1;  ///< tick; -1: none
  double force_difference = 0.0;       ///< [N] largest, of the virtual force
};

/// Compares the results of a tick with the recorded ones, bit for bit: of every arm the virtual
/// force, the coupling force, the torques, the lever torque and the gain.
void compare(const Recording& recording, std::size_t tick,
             std::span<const TickRecord* const> records, ReplayReport& report);

/// The clock of runs that are not in real time: regular, or as it was recorded.
class RegularClock {
 public:
  /// @param recording null: none
  RegularClock(const Recording* recording, std::chrono::nanoseconds period)
      : recording_(recording), period_(period) {}

  /// The time of the next tick. Reproduces recorded clock faults, as nanoseconds::min().
  [[nodiscard]] std::chrono::nanoseconds next(std::size_t tick) noexcept;

 private:
  const Recording* recording_;
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds now_{0};
};

}  // namespace repel::runs
