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
    checked("latch of the sampling energy", options.latch, 0.0, 1e6, "s");
    const double scale = period > 0.1 ? never : std::max(1.0, 400.0 * period);
    options_.taken_back *= scale;
    options_.most *= scale;
  }

  /// Advances by `elapsed` [s]. @param sampled [J] gained since the start, finite
  /// @param uncertain [J] by which it may be off at present; the largest of the last time counts
  /// @return status bits
  [[nodiscard]] Status step(double sampled, double elapsed, double uncertain = 0.0) noexcept {
    const double gain = sampled - last_;
    if (!(gain - gain == 0.0)) return status::energy_gain;  // not finite: nothing is known of it
    last_ = sampled;
    const double lost = std::min(1.0, elapsed / options_.memory);
    gained_ = std::max(0.0, gained_ + gain - lost * gained_);
    uncertain_ = std::max(uncertain, uncertain_ - lost * uncertain_);
    latched_ = std::max(0.0, latched_ - elapsed);
    since_ += elapsed;
    if (sure() > options_.most) latch();
    return latched_ > 0.0 || sure() > options_.most ? status::energy_gain : 0U;
  }

  /// Share of the damping against all motion that takes the energy back, 0 to 1.
  [[nodiscard]] double brake() const noexcept {
    if (!(sure() > options_.taken_back)) return 0.0;
    const double room = std::max(options_.most - options_.taken_back, 1e-12);
    return std::min((sure() - options_.taken_back) / room, 1.0);
  }
  [[nodiscard]] double gained() const noexcept { return gained_; }  ///< [J]

  /// Makes it a fault now, found by other means, for as long as one of its own.
  void latch() noexcept {
    if (latched_ == 0.0) times_ = since_ < 2.0 * longest * options_.latch ? 2.0 * times_ : 1.0;
    times_ = std::min(times_, longest);
    latched_ = times_ * options_.latch;
    since_ = 0.0;
  }

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
