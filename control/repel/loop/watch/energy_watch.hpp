// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Watches the energy that an arm gains because its torques are held while it moves on.
#pragma once

#include <limits>

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
  explicit EnergyWatch(double period, const EnergyWatchOptions& options = {});

  /// Advances by `elapsed` [s]. @param sampled [J] gained since the start, finite
  /// @param uncertain [J] by which it may be off at present; the largest of the last time counts
  /// @return status bits
  [[nodiscard]] Status step(double sampled, double elapsed, double uncertain = 0.0) noexcept;

  /// Share of the damping against all motion that takes the energy back, 0 to 1.
  [[nodiscard]] double brake() const noexcept;
  [[nodiscard]] double gained() const noexcept { return gained_; }  ///< [J]

  /// Makes it a fault now, found by other means, for as long as one of its own.
  void latch() noexcept;

 private:
  static constexpr double longest = 16.0;  // times `latch`

  [[nodiscard]] double sure() const noexcept { return gained_ - uncertain_; }

  EnergyWatchOptions options_;
  double last_ = 0.0;                                       // [J]
  double gained_ = 0.0;                                     // [J], forgotten over `memory`
  double uncertain_ = 0.0;                                  // [J], likewise
  double latched_ = 0.0;                                    // [s] for which a fault still stays
  double times_ = 1.0;                                      // `latch`
  double since_ = std::numeric_limits<double>::infinity();  // [s] the last fault
};

}  // namespace repel
