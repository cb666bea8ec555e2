// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Common base of the wrappers of simulated arms.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <repel/world/arm.hpp>

namespace repel {

/// Forwards everything to the arm inside; derived classes change a part of it. Allocates nothing.
class WrappedArm : public TorqueDrivenArm {
 public:
  /// @param arm not null
  explicit WrappedArm(std::unique_ptr<TorqueDrivenArm> arm) : arm_(std::move(arm)) {}

  void set_torques(std::span<const double> torques) noexcept override {
    arm_->set_torques(torques);
  }
  void step(double period) noexcept override { arm_->step(period); }
  void read_positions(std::span<double> out) const noexcept override { arm_->read_positions(out); }
  void read_velocities(std::span<double> out) const noexcept override {
    arm_->read_velocities(out);
  }
  void enable() noexcept override { arm_->enable(); }
  void stop() noexcept override { arm_->stop(); }
  void engage_brakes(bool on) noexcept override { arm_->engage_brakes(on); }
  [[nodiscard]] ArmState state() const noexcept override { return arm_->state(); }
  [[nodiscard]] ContactReport contact() const noexcept override { return arm_->contact(); }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return arm_->read_wrench();
  }

 protected:
  [[nodiscard]] TorqueDrivenArm& inside() noexcept { return *arm_; }              ///< the arm
  [[nodiscard]] const TorqueDrivenArm& inside() const noexcept { return *arm_; }  ///< likewise

 private:
  std::unique_ptr<TorqueDrivenArm> arm_;
};

}  // namespace repel
