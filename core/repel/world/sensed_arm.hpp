// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm whose force sensor has errors.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The errors of a force sensor, in its axes.
struct SensorErrors {
  double force_noise = 0.0;   ///< [N] along each axis at most, uniform and new in every step
  double torque_noise = 0.0;  ///< [N m] likewise
  Wrench bias{};              ///< [N, N m] constant
  std::uint64_t seed = 1;     ///< of the noise: the same seed gives the same noise

  /// There are none.
  [[nodiscard]] bool none() const noexcept {
    return force_noise == 0.0 && torque_noise == 0.0 && bias.force.isZero(0.0) &&
           bias.torque.isZero(0.0);
  }
};

/// An arm whose readings of force have errors, the same for the same seed. Everything else is that
/// of the arm it holds. Allocates at construction only.
class SensedArm final : public TorqueDrivenArm {
 public:
  /// @throws SetupError for an error that is negative or not finite
  SensedArm(std::unique_ptr<TorqueDrivenArm> arm, const SensorErrors& errors)
      : arm_(std::move(arm)), errors_(errors), rng_(errors.seed) {
    checked("noise of the force", errors.force_noise, 0.0, 1e6, "N");
    checked("noise of the torque", errors.torque_noise, 0.0, 1e6, "N m");
    checked("bias of the force", errors.bias.force.norm(), 0.0, 1e7, "N");
    checked("bias of the torque", errors.bias.torque.norm(), 0.0, 1e7, "N m");
    draw();
  }

  void set_torques(std::span<const double> torques) noexcept override {
    arm_->set_torques(torques);
  }
  void step(double period) noexcept override {
    arm_->step(period);
    draw();
  }
  void read_positions(std::span<double> out) const noexcept override { arm_->read_positions(out); }
  void read_velocities(std::span<double> out) const noexcept override {
    arm_->read_velocities(out);
  }
  void enable() noexcept override { arm_->enable(); }
  void stop() noexcept override { arm_->stop(); }
  void engage_brakes(bool on) noexcept override { arm_->engage_brakes(on); }
  /// That of the arm.
  [[nodiscard]] ArmState state() const noexcept override { return arm_->state(); }
  [[nodiscard]] ContactReport contact() const noexcept override { return arm_->contact(); }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    const std::optional<Wrench> exact = arm_->read_wrench();
    return exact ? std::optional(*exact + error_) : std::nullopt;
  }

 private:
  void draw() noexcept {
    error_ = errors_.bias;
    for (Eigen::Index i = 0; i < 3; ++i) {
      error_.force.coeffRef(i) += errors_.force_noise * uniform();
      error_.torque.coeffRef(i) += errors_.torque_noise * uniform();
    }
  }
  // -1 to 1, the same with every standard library.
  [[nodiscard]] double uniform() noexcept {
    return static_cast<double>(rng_() >> 11U) * 0x1p-52 - 1.0;
  }

  std::unique_ptr<TorqueDrivenArm> arm_;
  SensorErrors errors_;
  std::mt19937_64 rng_;
  Wrench error_;  // [N, N m] of this step
};

}  // namespace repel
