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
#include <repel/world/arm.hpp>

namespace repel {

/// An arm whose torques act some calls of `set_torques` later; until then none act. Everything else
/// is that of the arm it holds. Allocates at construction only.
class DelayedArm final : public TorqueDrivenArm {
 public:
  /// @param joints of `arm` @param delay [calls] 0 to 100
  /// @throws SetupError for a delay out of range
  DelayedArm(std::unique_ptr<TorqueDrivenArm> arm, std::size_t joints, int delay);

  void set_torques(std::span<const double> torques) noexcept override;
  void step(double period) noexcept override { arm_->step(period); }
  void read_positions(std::span<double> out) const noexcept override { arm_->read_positions(out); }
  void read_velocities(std::span<double> out) const noexcept override {
    arm_->read_velocities(out);
  }
  void enable() noexcept override { arm_->enable(); }
  void stop() noexcept override { arm_->stop(); }
  void engage_brakes(bool on) noexcept override { arm_->engage_brakes(on); }
  /// That of the arm, not delayed.
  [[nodiscard]] ArmState state() const noexcept override { return arm_->state(); }
  [[nodiscard]] ContactReport contact() const noexcept override { return arm_->contact(); }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return arm_->read_wrench();
  }

 private:
  std::unique_ptr<TorqueDrivenArm> arm_;
  std::size_t joints_;
  std::vector<double> under_way_;  // a ring, `joints_` torques for each call
  std::size_t at_ = 0;             // of the oldest
};

}  // namespace repel
