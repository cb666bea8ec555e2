// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The stop of each tick, and whether the brakes of the arm are requested.
#pragma once

#include <algorithm>

#include <repel/base/status.hpp>
#include <repel/loop/options.hpp>

namespace repel {

/// State machine from faults to the stop of a tick.
class StopControl {
 public:
  /// The arm runs. @param period [s].
  StopControl(double period, const StopOptions& options) noexcept
      : options_(options), predicted_(std::max(options.predicted, 3.0 * period)) {}

  /// The stop of this tick.
  /// @param lost the pose is unknown in this tick; `never_known`: it has never been known
  /// @param tripped the fail-safe does not restore the operator's force yet; `elapsed` [s]
  [[nodiscard]] Stop step(bool lost, bool never_known, bool tripped, double elapsed) noexcept;

  /// The brakes are requested.
  [[nodiscard]] bool brakes() const noexcept { return brakes_; }

 private:
  StopOptions options_;
  double predicted_;
  double lost_for_ = 0.0;  // [s]
  bool brakes_ = false;
};

}  // namespace repel
