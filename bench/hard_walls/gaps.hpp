// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The gaps before hard walls at the poses of arms that something else controls.
#pragma once

#include <chrono>
#include <span>

#include <repel/cell/cell.hpp>
#include <repel/loop/barrier/hard_contacts.hpp>

namespace repel::hard_walls {

/// An observer: a cell with hard walls at the poses of another one, without influence on it.
class Gaps {
 public:
  /// @param with_links also the gaps of links, and not of tools alone
  Gaps(CellDescription description, bool with_links);
  /// Takes the poses of a tick that is due at `now` [ns].
  void sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now);
  /// Collects the gaps at these poses that could close within `soon` [s].
  void collect(double soon) { contacts_.collect(cell_.coprocessor(), soon); }

  /// Those of the last `collect`.
  [[nodiscard]] std::span<const HardContact> all() const { return contacts_.all(); }
  /// The second cell.
  [[nodiscard]] Cell& cell() { return cell_; }

 private:
  Cell cell_;
  HardContacts contacts_;
};

}  // namespace repel::hard_walls
