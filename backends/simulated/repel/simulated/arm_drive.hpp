// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The drive of a simulated arm: enabled or stopped, brakes on or off, and a watchdog.
#pragma once

#include <limits>

#include <repel/base/setup_error.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Whether the torques of an arm act and its brakes are on. It starts enabled, brakes off.
class ArmDrive {
 public:
  /// @param watchdog [s] timeout without torques, in the arm's own time, after which it stops; 0,
  /// inf: never
  /// @throws SetupError when it is negative or NaN
  explicit ArmDrive(double watchdog = 0.0)
      : watchdog_(checked("watchdog", watchdog, 0.0, never, "s")) {
    if (watchdog_ == 0.0) watchdog_ = never;
  }

  /// As after construction.
  void reset() noexcept { enable(); }

  /// Torques act from now on, brakes are off, and the watchdog restarts.
  void enable() noexcept {
    state_ = ArmState::enabled;
    brakes_on_ = false;
    silent_ = 0.0;
  }

  /// No torque acts and brakes are on, until `enable`.
  void stop() noexcept { state_ = ArmState::stopped; }

  /// Brakes on or off while it is enabled; otherwise they stay on.
  void engage_brakes(bool on) noexcept {
    if (state_ == ArmState::enabled) brakes_on_ = on;
  }

  /// Torques were received: restarts the watchdog.
  void heard() noexcept { silent_ = 0.0; }

  /// Starts the next `period` [s] of the arm's time. Returns true when the watchdog expires within
  /// it: the drive stops, and the last torques are to be discarded, so that it restarts without
  /// any.
  [[nodiscard]] bool advance(double period) noexcept {
    silent_ += period;
    if (!(silent_ > watchdog_ * (1.0 + rounding))) return false;
    stop();
    return true;
  }

  /// True when the brakes hold the joints; no motor torque acts then.
  [[nodiscard]] bool braked() const noexcept { return state_ != ArmState::enabled || brakes_on_; }

  [[nodiscard]] ArmState state() const noexcept { return state_; }  ///< whether torques can act

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr double rounding = 1e-9;  // relative, of the sum of substeps

  double watchdog_;      // [s]
  double silent_ = 0.0;  // [s] since the last torques
  ArmState state_ = ArmState::enabled;
  bool brakes_on_ = false;
};

}  // namespace repel
