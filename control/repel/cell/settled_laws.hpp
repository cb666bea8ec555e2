// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a cell adds to the laws of its walls: damping for its rate and delays, and how far ahead
/// hard walls are watched.
#pragma once

#include <string>
#include <vector>

#include <repel/cell/description.hpp>

namespace repel {

/// [ticks] The delay of the slowest drive.
[[nodiscard]] double longest_delay(const CellDescription& cell) noexcept;

/// [s] The part of the delay of the slowest drive that a faster tick does not shorten.
[[nodiscard]] double longest_response(const CellDescription& cell) noexcept;

/// [ticks] How late the force of a wall acts: as late as the slowest drive, and a tick more where
/// the coprocessor works beside.
[[nodiscard]] double wall_delay(const CellDescription& cell) noexcept;

/// The stopping distance [m], up to 1 m, of arms and moving obstacles that approach each other at
/// 1.5 times the speed limits: with 2 m/s^2, which most arms are capable of, after their slew time
/// and the delay of the slowest drive. What comes faster is braked later, as hard as the efforts
/// allow.
[[nodiscard]] double stopping_distance(const CellDescription& cell) noexcept;

/// Raises the damping of each law where it may rise, and where a wall is stable without the extra
/// tick of asynchronous results. Raises `watched` of hard walls to the stopping distance. Not for
/// the tick.
/// @return one sentence for each damping that was raised beyond what it was given
std::vector<std::string> settle_laws(CellDescription& cell);

}  // namespace repel
