/// @file
/// SPACEBALL: a six-degree-of-freedom rate source, one way only.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/base/spatial.hpp>

namespace repel::network {

struct SpaceballOptions {
  double dead_band = 0.002;         ///< [m/s] rates below are rest
  double saturation = 0.25;         ///< [m/s]
  double angular_dead_band = 0.01;  ///< [rad/s]
  double angular_saturation = 1.0;  ///< [rad/s]
  double time_constant = 0.05;      ///< [s] of the low pass; 0 for none
};

/// Dead band, saturation and a first-order low pass, each on the length of the vector, so that the
/// direction is the operator's own. It takes no effort back: it is a source, outside any claim of
/// passivity.
class Spaceball {
 public:
  explicit Spaceball(const SpaceballOptions& options) noexcept : options_(options) {}

  void reset() noexcept { filtered_ = {}; }

  /// The commanded twist for raw `rates`, one `period` [s] later.
  [[nodiscard]] Twist step(const Twist& rates, double period) noexcept {
    const double share = period / (period + options_.time_constant);
    const Vec3 linear = shaped(rates.linear, options_.dead_band, options_.saturation);
    const Vec3 angular =
        shaped(rates.angular, options_.angular_dead_band, options_.angular_saturation);
    filtered_.linear += share * (linear - filtered_.linear);
    filtered_.angular += share * (angular - filtered_.angular);
    return filtered_;
  }

 private:
  [[nodiscard]] static Vec3 shaped(const Vec3& v, double dead_band, double most) noexcept {
    const double length = v.norm();
    if (!(length > dead_band)) return Vec3::Zero();
    return v * (std::min(length - dead_band, most) / length);
  }

  SpaceballOptions options_;
  Twist filtered_;
};

}  // namespace repel::network
