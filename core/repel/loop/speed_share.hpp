/// @file
/// Keeps the tool within the speed it may have.
#pragma once

#include <algorithm>

namespace repel {

/// What is left of what drives the tool, and how much the arm brakes, at a speed.
struct SpeedShare {
  double drive = 1.0;  ///< 1 up to the limit, 0 from 1.2 times it
  double brake = 0.0;  ///< 0 up to 1.2 times the limit, 1 from 1.5 times it
};

/// @param speed of the tool [m/s]; `limit` [m/s] at which the operator may lead it, above 0
[[nodiscard]] inline SpeedShare speed_share(double speed, double limit) noexcept {
  const double part = speed / limit;
  return {std::clamp(1.0 - (part - 1.0) / 0.2, 0.0, 1.0), std::clamp((part - 1.2) / 0.3, 0.0, 1.0)};
}

}  // namespace repel
