/// @file
/// Support for replays: comparison with the recording, and the clock of the ticks.
#pragma once

#include <chrono>
#include <span>

#include "run.hpp"

namespace repel::teleop {

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

}  // namespace repel::teleop
