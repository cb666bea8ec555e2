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

/// The time of the clock that a tick is told: regular, unless it stood still when it was recorded.
[[nodiscard]] std::chrono::nanoseconds clock_of(const Recording* recording, std::size_t tick,
                                                std::chrono::nanoseconds period);

}  // namespace repel::teleop
