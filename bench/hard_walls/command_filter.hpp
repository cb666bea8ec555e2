// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What others do to hold a tool off: the commanded twist is changed before it is followed.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

#include <repel/cell/cell.hpp>
#include <repel/loop/hard_contacts.hpp>

#include "setting.hpp"

namespace repel::hard_walls {

/// Changes twists by the gaps of a second cell at the same poses.
class CommandFilter {
 public:
  /// @param description of the second cell, with hard walls
  CommandFilter(Way way, CellDescription description);
  /// Takes the poses of a tick that is due at `now` [ns].
  void sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now);
  /// Changes what the hand of an arm commands [m/s, rad/s].
  void filter(std::size_t arm, Twist& V) const;

 private:
  // [m/s] at a gap [m]
  [[nodiscard]] double allowed(double gap) const;

  Way way_;
  Cell cell_;
  std::optional<HardContacts> contacts_;
};

}  // namespace repel::hard_walls
