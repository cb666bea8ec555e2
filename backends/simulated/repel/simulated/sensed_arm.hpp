// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm whose force sensor has errors.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>

#include <repel/base/spatial.hpp>
#include <repel/simulated/built_alike.hpp>
#include <repel/simulated/wrapped_arm.hpp>

namespace repel {

/// The errors of a force sensor, in its axes.
struct SensorErrors {
  double force_noise = 0.0;   ///< [N] along each axis at most, uniform and new in every step
  double torque_noise = 0.0;  ///< [N m] likewise
  Wrench bias{};              ///< [N, N m] constant
  std::uint64_t seed = 1;     ///< of the noise: the same seed gives the same noise

  /// There are none.
  [[nodiscard]] bool none() const noexcept;
};

/// An arm whose readings of force have errors, the same for the same seed. Everything else is that
/// of the arm it holds. Allocates at construction only.
class SensedArm final : public WrappedArm {
 public:
  /// @throws SetupError for an error that is negative or not finite
  SensedArm(std::unique_ptr<TorqueDrivenArm> arm, const SensorErrors& errors);

  void step(double period) noexcept override;
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override;

 private:
  void draw() noexcept;
  // -1 to 1, the same with every standard library.
  [[nodiscard]] double uniform() noexcept;

  SensorErrors errors_;
  std::mt19937_64 rng_;
  Wrench error_;  // [N, N m] of this step
};

}  // namespace repel
