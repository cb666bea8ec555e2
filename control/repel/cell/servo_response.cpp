// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/servo_response.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include <repel/base/setup_error.hpp>

namespace repel {

namespace {

/// A log of one joint, and the error of a model of its servo.
struct ServoLog {
  std::span<const double> commanded, measured;
  double period;  // [s]

  /// The command `delay` [periods] before number k; before the first one it stood still.
  [[nodiscard]] double command_at(std::size_t k, double delay) const noexcept {
    const double at = static_cast<double>(k) - delay;
    if (at <= 0.0) return commanded.front();
    const auto before = static_cast<std::size_t>(at);
    if (before + 1 >= commanded.size()) return commanded.back();
    const double share = at - static_cast<double>(before);
    return commanded[before] + share * (commanded[before + 1] - commanded[before]);
  }

  /// Mean square [rad^2] of what the model leaves of the measured positions, less its mean.
  [[nodiscard]] double left_by(double dead_time, double lag) const noexcept {
    const double delay = dead_time / period;
    const double share = lag > 0.0 ? -std::expm1(-period / lag) : 1.0;
    double followed = commanded.front();
    double last = commanded.front();
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      // The command changes evenly within a period: then a ramp is followed exactly by the lag.
      const double next = command_at(k, delay);
      const double slope = (next - last) / period;
      followed += share * (last - lag * slope - followed) + (next - last);
      if (lag == 0.0) followed = next;
      last = next;
      const double left = measured[k] - followed;
      sum += left;
      squares += left * left;
    }
    const auto count = static_cast<double>(measured.size());
    return std::max(0.0, squares / count - sum / count * (sum / count));
  }
};

}  // namespace

ServoResponse find_response(std::span<const double> commanded, std::span<const double> measured,
                            double period) {
  checked("period", period, 1e-6, 1.0, "s");
  if (commanded.size() != measured.size() || commanded.size() < ServoResponse::fewest) {
    throw SetupError("a log has " + std::to_string(commanded.size()) + " commanded and " +
                     std::to_string(measured.size()) + " measured positions; allowed: " +
                     std::to_string(ServoResponse::fewest) + " or more, as many of both");
  }
  for (const std::span<const double> positions : {commanded, measured}) {
    for (std::size_t k = 0; k < positions.size(); ++k) {
      if (std::isfinite(positions[k])) continue;
      throw SetupError("position " + std::to_string(k) + " of a log is not finite");
    }
  }
  const ServoLog log{commanded, measured, period};
  const auto [least, most] = std::minmax_element(measured.begin(), measured.end());
  ServoResponse best{.moved = *most - *least};
  double left = log.left_by(0.0, 0.0);
  const auto try_one = [&](double dead_time, double lag) {
    const double found = log.left_by(dead_time, lag);
    if (!(found < left)) return false;
    left = found;
    best.dead_time = dead_time;
    best.lag = lag;
    return true;
  };
  // The valley of equal sums is narrow, so a grid finds its lowest part before small steps do.
  constexpr double longest = ServoResponse::longest;
  constexpr int along = 50;
  const double coarse = longest / along;
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= along; ++j) (void)try_one(i * coarse, j * coarse);
  }
  for (double step = coarse; step > 1e-3 * period;) {
    bool is_better = false;
    for (const auto& [along_dead_time, along_lag] :
         {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}, {1.0, -1.0}, {-1.0, 1.0}}) {
      const double dead_time = std::clamp(best.dead_time + along_dead_time * step, 0.0, longest);
      const double lag = std::clamp(best.lag + along_lag * step, 0.0, longest);
      is_better = try_one(dead_time, lag) || is_better;
    }
    if (!is_better) step *= 0.5;
  }
  best.error = std::sqrt(left);
  return best;
}

}  // namespace repel
