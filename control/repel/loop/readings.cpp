// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/readings.hpp>

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace repel {

void copy_readings(std::span<const double> from, std::vector<double>& to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = i < from.size() ? from[i] : std::numeric_limits<double>::quiet_NaN();
  }
}

void pass_wrench(const std::optional<Wrench>& reading, const network::ForceSensor& sensor,
                 network::Signals& signals) noexcept {
  signals.is_measured = reading.has_value() && is_finite(*reading);
  signals.measured = signals.is_measured ? *reading : Wrench{};
  signals.inertia *= 1.0 / (1.0 + sensor.gain());
}

}  // namespace repel
