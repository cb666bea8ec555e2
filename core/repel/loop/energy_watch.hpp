// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Watches the energy that an arm gains because its torques are held while it moves on.
#pragma once

#include <algorithm>
#include <limits>

#include <repel/base/setup_error.hpp>
#include <repel/base/status.hpp>
#include <repel/loop/options.hpp>

namespace repel {

/// The network counts the power that it gives to the arm at the rates it measured; the arm takes
/// torque times the motion until the next tick. The difference, "by sampling", stays small while a
/// coupling suits the arm (bench/results/arms.md) and grows without bound where it does not. It is
/// taken back by the braking of the loop, in proportion to M; what cannot be taken back is a fault.
class EnergyWatch {
 public:
  /// @param period [s]; @throws SetupError for an option out of range
  explicit EnergyWatch(double period, const EnergyWatchOptions& options = {}) : options_(options) {
    constexpr double never = std::numeric_limits<double>::infinity();
    checked("sampling energy taken back", options.taken_back, 0.0, 1e9, "J");
    checked("most sampling energy", options.most, options.taken_back, never, "J");
    checked("memory of the sampling energy", options.memory, 1e-3, 1e6, "s");
    const double scale = period > 0.1 ? never : std::max(1.0, 400.0 * period);
    options_.taken_back *= scale;
    options_.most *= scale;
  }

  /// Advances by `elapsed` [s]. @param sampled [J] by sampling since the start,
  /// finite
  /// @return status bits
  [[nodiscard]] Status step(double sampled, double elapsed) noexcept {
    const double gain = sampled - last_;
    last_ = sampled;
    gained_ += gain - std::min(1.0, elapsed / options_.memory) * std::max(0.0, gained_);
    gained_ = std::max(gained_, 0.0);
    return gained_ > options_.most ? status::energy_gain : 0U;
  }

  /// Share of the damping against all motion that takes the energy back, 0 to 1.
  [[nodiscard]] double brake() const noexcept {
    if (!(gained_ > options_.taken_back)) return 0.0;
    const double room = std::max(options_.most - options_.taken_back, 1e-12);
    return std::min((gained_ - options_.taken_back) / room, 1.0);
  }
  [[nodiscard]] double gained() const noexcept { return gained_; }  ///< [J]

 private:
  EnergyWatchOptions options_;
  double last_ = 0.0;    // [J]
  double gained_ = 0.0;  // [J], forgotten over `memory`
};

}  // namespace repel
