// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Removes the operator's force when an input cannot be trusted.
#pragma once

#include <repel/base/status.hpp>
#include <repel/loop/options.hpp>

namespace repel {

/// The gain of the operator's force: 1 while inputs are valid, ramped to 0 by a fault of
/// `status::failsafe`, held there until inputs have been valid for a while, then ramped back.
class Failsafe {
 public:
  /// Begins with the full gain.
  explicit Failsafe(const FailsafeOptions& options = {}) noexcept : options_(options) {}

  /// The gain for this tick, 0 to 1.
  [[nodiscard]] double step(Status status, double period) noexcept;

  /// The gain of the last tick.
  [[nodiscard]] double gain() const noexcept { return gain_; }
  /// True from a fault until the force has begun to come back.
  [[nodiscard]] bool tripped() const noexcept { return tripped_; }

 private:
  FailsafeOptions options_;
  double gain_ = 1.0;
  double sound_for_ = 0.0;
  bool tripped_ = false;
};

}  // namespace repel
