// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The readings of an arm, as a tick takes them.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/modules/force_sensor.hpp>

namespace repel {

/// Copies the readings `from` an arm; missing entries read as NaN.
inline void copy_readings(std::span<const double> from, std::vector<double>& to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = i < from.size() ? from[i] : std::numeric_limits<double>::quiet_NaN();
  }
}

/// Gives a network with a force sensor its reading, and the inertia of the arm in `signals` as the
/// modules on its left move it.
inline void pass_wrench(const std::optional<Wrench>& reading, const network::ForceSensor& sensor,
                        network::Signals& signals) noexcept {
  signals.is_measured = reading.has_value() && is_finite(*reading);
  signals.measured = signals.is_measured ? *reading : Wrench{};
  signals.inertia *= 1.0 / (1.0 + sensor.gain());
}

}  // namespace repel
