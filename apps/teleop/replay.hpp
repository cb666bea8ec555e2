/// @file
/// Going through a recording again: what is compared, and what the clock is said to be.
#pragma once

#include <chrono>
#include <span>

#include "run.hpp"

namespace repel::teleop {

/// Compares what came out of a tick with what was recorded of it, bit for bit: the virtual force,
/// the force of the operator's side, the lever, the torques and the gain of every arm.
void compare(const Recording& recording, std::size_t tick,
             std::span<const TickRecord* const> records, ReplayReport& report);

/// What the clock is said to be in runs that do not go by it: regular, or as it was recorded.
class RegularClock {
 public:
  /// @param recording null: none
  RegularClock(const Recording* recording, std::chrono::nanoseconds period)
      : recording_(recording), period_(period) {}

  /// The time that a tick is told, one after the other. A clock that stood still did so again.
  [[nodiscard]] std::chrono::nanoseconds next(std::size_t tick) noexcept;

 private:
  const Recording* recording_;
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds now_{0};
};

}  // namespace repel::teleop
