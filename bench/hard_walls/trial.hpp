// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms of a scene, in a simulation, and hands that push them at random.
#pragma once

#include <cstdint>
#include <optional>

#include <repel/base/status.hpp>
#include <repel/common/deadline.hpp>

#include "setting.hpp"

namespace repel::hard_walls {

inline constexpr double tolerated = 1e-4;  ///< [m] to which a hard wall may be entered

/// What came of it.
struct Outcome {
  double deepest = 0.0;                 ///< [m] into a wall, by the proven bound of the library
  double by_libccd = 0.0;               ///< [m] the same by libccd, where it looked
  double tool = 0.0;                    ///< [m] the same, of tools alone
  double withstood = 0.0;               ///< [N]
  double way = 0.0;                     ///< [m] that the tools moved
  std::int64_t lost = 0;                ///< ticks
  std::optional<std::int64_t> told;     ///< first tick in which a wall was said to be lost
  std::optional<std::int64_t> entered;  ///< first tick in which one was entered by either
  DurationHistogram compute;            ///< of the cell
  DurationHistogram filter;             ///< of what changes commands or torques, for all arms
  double sampling_energy = 0.0;         ///< [J] most
  double fastest_joint = 0.0;           ///< [rad/s]
  double chatter = 0.0;                 ///< [N m] rms of the last joint, while the hand rests
  Status said = 0;                      ///< in some tick

  /// A wall was entered, and no tick before said that it would be.
  [[nodiscard]] bool is_untold() const { return entered && !(told && *told < *entered); }
};

/// Runs it. Deterministic, but for the times.
[[nodiscard]] Outcome push(const Setting& setting);

}  // namespace repel::hard_walls
