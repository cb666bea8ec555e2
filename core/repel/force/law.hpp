/// @file
/// The force law: how a signed distance and its rate become a force. This is the file to change
/// when a wall should feel different.
#pragma once

#include <algorithm>
#include <limits>

#include <repel/base/setup_error.hpp>

namespace repel {

/// The nonlinear spring-damper of one pair (Anderson 1993, section 2: zero outside a threshold
/// region, a large force at the surface).
///
///     phi(d) = F (1 - d/r)^2    0 <= d < r       zero slope at the range r
///            = F (1 - 2 d/r)    d < 0            goes on rising with the slope it has at 0
///     c(d)   = c0 min(1, 1 - d/r)                no damping at the range, all of it from 0 on
///     f      = min(max(0, phi(d) - c(d) d'), ceiling)
///
/// So the force is continuous, never pulls, and grows less when the body retreats (d' > 0): leaving
/// is never resisted. A low ceiling makes a membrane, which can be pushed through.
struct ForceLaw {
  double range = 0.02;                                       ///< r [m] where the force begins
  double surface_force = 100.0;                              ///< F [N] at distance 0
  double damping = 50.0;                                     ///< c0 [N s/m]
  double ceiling = std::numeric_limits<double>::infinity();  ///< [N] greatest force of the pair

  /// phi(d) [N], never negative, without the ceiling.
  [[nodiscard]] double spring(double distance) const noexcept {
    if (distance >= range) return 0.0;
    const double inward = 1.0 - distance / range;
    return distance > 0.0 ? surface_force * inward * inward
                          : surface_force * (1.0 - 2.0 * distance / range);
  }

  /// c(d) [N s/m].
  [[nodiscard]] double damper(double distance) const noexcept {
    return damping * std::clamp(1.0 - distance / range, 0.0, 1.0);
  }

  /// Size of the force along the extraction direction [N], 0 to `ceiling`.
  /// @param distance [m] signed
  /// @param rate [m/s] its rate of change; positive on retreat
  [[nodiscard]] double operator()(double distance, double rate) const noexcept {
    if (!(distance < range)) return 0.0;
    return std::clamp(spring(distance) - damper(distance) * rate, 0.0, ceiling);
  }

  /// Largest slope of the spring [N/m]: what a sampled wall must be able to hold.
  [[nodiscard]] double stiffness() const noexcept { return 2.0 * surface_force / range; }
};

/// Returns `law` when every number of it is usable; throws SetupError naming the one that is not.
inline const ForceLaw& checked(const ForceLaw& law) {
  constexpr double most = 1e9;
  checked("range", law.range, 1e-9, most, "m");
  checked("surface force", law.surface_force, 0.0, most, "N");
  checked("damping", law.damping, 0.0, most, "N s/m");
  checked("ceiling", law.ceiling, 0.0, std::numeric_limits<double>::infinity(), "N");
  return law;
}

}  // namespace repel
