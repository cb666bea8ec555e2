/// @file
/// LIMITS: joint limit restrictions felt before the stops are hit.
#pragma once

#include <algorithm>

namespace repel::network {

/// A one-sided spring-damper at each end of a joint's range. It only ever pushes inward.
struct JointLimits {
  double range = 0.1;        ///< [rad] or [m] before the limit where it begins
  double stiffness = 200.0;  ///< [N m/rad] or [N/m]
  double damping = 10.0;     ///< [N m s/rad] or [N s/m]

  /// The torque [N m] at position `q` moving at `v`, for a joint between `lower` and `upper`.
  [[nodiscard]] double operator()(double q, double v, double lower, double upper) const noexcept {
    const double below = lower + range - q;
    const double above = q - (upper - range);
    if (below > 0.0) return std::max(0.0, stiffness * below - damping * v);
    if (above > 0.0) return std::min(0.0, -stiffness * above - damping * v);
    return 0.0;
  }
};

}  // namespace repel::network
