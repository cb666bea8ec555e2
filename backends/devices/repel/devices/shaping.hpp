// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Maps the deflection of a six-axis device to commanded rates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>

namespace repel::devices {

/// The axis of the device that drives an axis of the twist, and its sign.
struct AxisSource {
  int axis = 0;       ///< of the device: x, y, z, rx, ry, rz from 0
  double sign = 1.0;  ///< 1 or -1
};

/// Parameters of the map from deflection to rate.
struct ShapingOptions {
  double full_travel = 350.0;  ///< [counts] of an axis at its mechanical stop
  double dead_band = 0.05;     ///< fraction of full travel
  double exponent = 1.0;       ///< 1: linear; above 1: finer near rest
  double linear_scale = 0.25;  ///< [m/s] at full travel
  double angular_scale = 1.0;  ///< [rad/s] at full travel
  /// Sources of the linear and then the angular axes of the twist: x forward, y left, z up as seen
  /// by the operator, from spacenavd's x right, y up, z forward. The same choice as ROS's
  /// spacenav_node.
  std::array<AxisSource, 6> axes{{{2, 1.0}, {0, -1.0}, {1, 1.0}, {5, 1.0}, {3, -1.0}, {4, 1.0}}};
};

/// Maps each axis independently by f(x) = sign(x) ((|x| - d) / (1 - d))^e for |x| in [d, 1], 0
/// below and 1 above: odd, monotone and continuous at the edge of the dead band d.
class Shaping {
 public:
  /// @throws SetupError if a number is out of range
  explicit Shaping(const ShapingOptions& options = {}) : options_(options) {
    checked("full travel", options.full_travel, 1.0, 10000.0, "counts");
    checked("dead band", options.dead_band, 0.0, 0.9, "of full travel");
    checked("exponent", options.exponent, 1.0, 5.0, "of the deflection");
    checked("linear scale", options.linear_scale, 0.0, 10.0, "m/s");
    checked("angular scale", options.angular_scale, 0.0, 100.0, "rad/s");
    for (const AxisSource& source : options.axes) check(source);
  }

  /// f of a fraction of full travel, -1 to 1; 0 if not finite.
  [[nodiscard]] double share(double deflection) const noexcept {
    if (!std::isfinite(deflection)) return 0.0;
    const double size = std::min(1.0, std::abs(deflection));
    if (size <= options_.dead_band) return 0.0;
    const double inside = (size - options_.dead_band) / (1.0 - options_.dead_band);
    return std::copysign(std::pow(inside, options_.exponent), deflection);
  }

  /// [m/s, rad/s] from the six axes of the device in counts; always finite.
  [[nodiscard]] Twist twist(std::span<const double, 6> counts) const noexcept {
    Twist result;
    for (int i = 0; i < 3; ++i) {
      result.linear(i) = options_.linear_scale * driven(i, counts);
      result.angular(i) = options_.angular_scale * driven(i + 3, counts);
    }
    return result;
  }

  [[nodiscard]] const ShapingOptions& options() const noexcept { return options_; }  ///< as given

 private:
  [[nodiscard]] double driven(int i, std::span<const double, 6> counts) const noexcept {
    const AxisSource& source = options_.axes[static_cast<std::size_t>(i)];
    return source.sign *
           share(counts[static_cast<std::size_t>(source.axis)] / options_.full_travel);
  }

  static void check(const AxisSource& source) {
    if (source.axis < 0 || source.axis > 5) {
      std::string text = "the axis of a device is ";
      text += std::to_string(source.axis);
      text += "; allowed: 0 to 5 for x, y, z, rx, ry, rz";
      throw SetupError(text);
    }
    if (source.sign != 1.0 && source.sign != -1.0) {
      std::string text = "the sign of an axis is ";
      text += repel::to_text(source.sign);
      text += "; allowed: 1 and -1";
      throw SetupError(text);
    }
  }

  ShapingOptions options_;
};

}  // namespace repel::devices
