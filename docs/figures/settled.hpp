// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How still the plates are: what a run shows after the push at the corner is over.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "plates.hpp"

namespace repel::figures {

struct Settled {
  double tilt = 0.0;         ///< [rad] largest from 6 s on
  double chatter = 0.0;      ///< [N] root mean square of the force above 30 Hz, from 6 s on
  double torque_jump = 0.0;  ///< [N m] largest from one tick to the next, from 6 s on
  double speed = 0.0;        ///< [m/s] of the fastest corner at the end
  double pushed_tilt = 0.0;  ///< [rad] largest during the push and after it
};

/// Root mean square of what is above `cutoff` [Hz] in `values`: all of it, by Parseval's theorem,
/// less what is below.
inline double rms_above(double cutoff, const std::vector<double>& values, double rate) {
  const auto count = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double v : values) mean += v / count;
  double energy = 0.0;
  for (const double v : values) energy += (v - mean) * (v - mean) / count;
  for (int bin = 1; bin <= cutoff * count / rate; ++bin) {
    double c = 0.0;
    double s = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double phase = 2.0 * std::numbers::pi * bin * static_cast<double>(k) / count;
      c += (values[k] - mean) * std::cos(phase);
      s += (values[k] - mean) * std::sin(phase);
    }
    energy -= 2.0 * (c * c + s * s) / (count * count);
  }
  return std::sqrt(std::max(0.0, energy));
}

inline Settled settled(const std::vector<PlatesTick>& ticks, double rate) {
  Settled result{.speed = ticks.back().speed};
  std::vector<double> forces;
  for (std::size_t k = 1; k < ticks.size(); ++k) {
    const PlatesTick& tick = ticks[k];
    if (tick.time >= 2.0) result.pushed_tilt = std::max(result.pushed_tilt, tick.tilt);
    if (tick.time < 6.0) continue;
    const double jump = (tick.F_W.torque - ticks[k - 1].F_W.torque).norm();
    result.tilt = std::max(result.tilt, tick.tilt);
    result.torque_jump = std::max(result.torque_jump, jump);
    forces.push_back(tick.F_W.force.norm());
  }
  result.chatter = rms_above(30.0, forces, rate);
  return result;
}

}  // namespace repel::figures
