// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/energy_watch.hpp>

#include <algorithm>
#include <limits>

#include <repel/base/setup_error.hpp>

namespace repel {

EnergyWatch::EnergyWatch(double period, const EnergyWatchOptions& options) : options_(options) {
  constexpr double never = std::numeric_limits<double>::infinity();
  checked("sampling energy taken back", options.taken_back, 0.0, 1e9, "J");
  checked("most sampling energy", options.most, options.taken_back, never, "J");
  checked("memory of the sampling energy", options.memory, 1e-3, 1e6, "s");
  checked("latch of the sampling energy", options.latch, 0.0, 1e6, "s");
  const double scale = period > 0.1 ? never : std::max(1.0, 400.0 * period);
  options_.taken_back *= scale;
  options_.most *= scale;
}

Status EnergyWatch::step(double sampled, double elapsed, double uncertain) noexcept {
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

double EnergyWatch::brake() const noexcept {
  if (!(sure() > options_.taken_back)) return 0.0;
  const double room = std::max(options_.most - options_.taken_back, 1e-12);
  return std::min((sure() - options_.taken_back) / room, 1.0);
}

void EnergyWatch::latch() noexcept {
  if (latched_ == 0.0) times_ = since_ < 2.0 * longest * options_.latch ? 2.0 * times_ : 1.0;
  times_ = std::min(times_, longest);
  latched_ = times_ * options_.latch;
  since_ = 0.0;
}

}  // namespace repel
