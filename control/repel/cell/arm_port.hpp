// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Adapter between a cell and an in-process arm, e.g. a simulation or a recording.
#pragma once

#include <vector>

#include <repel/loop/record.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Reads an arm before a tick and applies the resulting record after it. All memory is allocated at
/// construction.
class ArmPort {
 public:
  /// @param arm must outlive the port; it has `joints` joints
  ArmPort(TorqueDrivenArm& arm, std::size_t joints) : arm_(&arm), q_(joints), v_(joints) {}

  /// The present joint readings; valid until the next call.
  [[nodiscard]] ArmReadings read() noexcept;

  /// Sends the torques of a tick to the arm, and what it asks of drive and brakes.
  void apply(const TickRecord& record) noexcept;

 private:
  TorqueDrivenArm* arm_;
  std::vector<double> q_, v_;
};

}  // namespace repel
