// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faults of a run, between its first arm and its cell.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/runs/faults/choice.hpp>
#include <repel/runs/faults/exchange.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::faults {

/// Faults of one arm, each from its time on; several of one kind act one after the other. Every
/// number is the same in each run, that of noise as well. Allocates at construction only.
class InjectedFaults {
 public:
  /// @param arm that has them, the first of its cell @param rate_hz [Hz] of the tick
  /// @throws SetupError as `fault_named`, for a time out of range, and for a fault that an arm of a
  /// single joint cannot have
  InjectedFaults(std::span<const Choice> choices, const ArmDescription& arm, double rate_hz);
  InjectedFaults(const InjectedFaults&) = delete;
  InjectedFaults& operator=(const InjectedFaults&) = delete;
  ~InjectedFaults() = default;

  /// The kinematics or the simulated arm, with the faults of that kind. This must outlive it.
  [[nodiscard]] std::unique_ptr<ArmKinematics> spoilt(std::unique_ptr<ArmKinematics> sound);
  [[nodiscard]] std::unique_ptr<TorqueDrivenArm> spoilt(std::unique_ptr<TorqueDrivenArm> sound);

  /// To be called before each tick: begins those whose time has come, by the time of the cell.
  /// @param last record of the arm; null before the first tick
  void begin_tick(const Cell& cell, const TickRecord* last) noexcept;

  /// What the clock says at a tick.
  struct Told {
    std::chrono::nanoseconds now;  ///< what the tick is told
    std::int64_t missed = 0;       ///< ticks that the loop stands still before it
  };
  /// @param now when the tick is due, without faults
  [[nodiscard]] Told tell(std::chrono::nanoseconds now) noexcept;

  /// What the cell reads. Valid until the next call.
  void spoil(ArmReadings& readings) noexcept;
  /// What the operator commands.
  void spoil(network::Command& command) noexcept;

 private:
  struct Injected {
    const Fault* fault;
    double begin;  // [s]
    Exchange x;
  };

  /// Finds the joints of the fault and the direction of the wall.
  void aim(Exchange& x, const Cell& cell, const TickRecord* last) noexcept;

  double period_;  // [s]
  std::chrono::nanoseconds period_ns_;
  std::vector<double> start_;  // [rad] or [m]
  Kinematics kinematics_;
  Jacobian jacobian_;
  std::chrono::nanoseconds stood_{0};  // for which the loop has stood still so far
  std::vector<Injected> all_;          // of fixed size: others refer to its entries
};

}  // namespace repel::faults
