// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm whose drive is late.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <repel/simulated/built_alike.hpp>
#include <repel/simulated/wrapped_arm.hpp>

namespace repel {

/// An arm whose torques act some calls of `set_torques` later; until then none act. Everything else
/// is that of the arm it holds. Allocates at construction only.
class DelayedArm final : public WrappedArm {
 public:
  /// @param joints of `arm` @param delay [calls] 0 to 100
  /// @throws SetupError for a delay out of range
  DelayedArm(std::unique_ptr<TorqueDrivenArm> arm, std::size_t joints, int delay);

  void set_torques(std::span<const double> torques) noexcept override;

 private:
  std::size_t joints_;
  std::vector<double> under_way_;  // a ring, `joints_` torques for each call
  std::size_t at_ = 0;             // of the oldest
};

}  // namespace repel
