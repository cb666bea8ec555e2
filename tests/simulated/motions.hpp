// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A motion of a PUMA that can be run on any engine, and the difference of two such motions.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace repel::simulated {

/// Joint positions [rad] over one second under slowly varying torques, tick by tick.
template <class Simulated>
std::vector<std::vector<double>> motion_of(Simulated arm) {
  arm.reset(std::vector{0.2, 0.9, 0.1, -0.3, 0.4, 0.5});
  std::vector<std::vector<double>> positions;
  for (int tick = 0; tick < 400; ++tick) {
    const double s = std::sin(0.02 * tick);
    arm.set_torques(std::vector{10.0 * s, 45.0 - 20.0 * s, 8.0 * s, 1.0 * s, -1.0 * s, 0.5 * s});
    arm.step(1.0 / 400.0);
    positions.emplace_back(6);
    arm.read_positions(positions.back());
  }
  return positions;
}

/// The largest difference [rad] of a joint at any tick.
inline double apart(const std::vector<std::vector<double>>& a,
                    const std::vector<std::vector<double>>& b) {
  double most = 0.0;
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    for (std::size_t i = 0; i < a[tick].size(); ++i) {
      most = std::max(most, std::abs(a[tick][i] - b[tick][i]));
    }
  }
  return most;
}

}  // namespace repel::simulated
