// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The record of a tick with the names of what it counts.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <repel/cell/cell.hpp>

namespace repel::python {

/// What the numbers of a record stand for.
struct TickNames {
  std::vector<std::string> pairs;    ///< by PairId
  std::vector<std::string> modules;  ///< of the network of the arm
  std::size_t joints = 0;            ///< of the arm
};

/// A copy of the record, which outlives the next tick.
struct Tick {
  TickRecord record;
  std::shared_ptr<const TickNames> names;
  std::vector<double> positions{};  ///< [rad] or [m] for an arm that takes motion; empty: torques
  std::vector<double> rates{};      ///< [rad/s] or [m/s] likewise
};

/// One for each arm of a cell.
[[nodiscard]] std::vector<std::shared_ptr<const TickNames>> names_of(const Cell& cell);

}  // namespace repel::python
