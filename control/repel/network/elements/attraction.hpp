// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force towards a virtual fixture as a function of the distance from it, with its potential.
#pragma once

#include <repel/base/types.hpp>

namespace repel::network {

/// The numbers of an attraction along a distance, or about an angle.
struct AttractionLimits {
  double stiffness = 1000.0;  ///< k [N/m] or [N m/rad]
  double most_force = 30.0;   ///< F [N] or [N m]
  double range = 0.1;         ///< r [m] or [rad] beyond which it does not attract
  double most_energy = 2.0;   ///< E [J] depth of the potential; the force is lowered to keep it
};

/// A saturated spring whose force fades towards the border of its range. With P its greatest force
/// and a = P / k:
///
///     f(d) = k d                               d <= a / 2
///          = k d - k (d - a / 2)^2 / (2 a)     a / 2 < d <= 3 a / 2, the force rounds off to P
///          = P                                 3 a / 2 < d <= r / 2
///          = P (1 - 3 t^2 + 2 t^3)             r / 2 < d < r, t = (d - r / 2) / (r / 2)
///          = 0                                 r <= d
///
/// P is F, at most k r / 3, and such that U(r) is at most E. So f and f(d) / d, the stiffness
/// across, have a continuous slope of magnitude at most k. U is its integral from 0.
///
/// With a soft start, for the outside of a tube or a cone, the slope begins at zero as well: f(d) =
/// k d^2 / (2 e) up to d = e, a tenth of the range or a / 2 if that is less, and goes on as above.
class Attraction {
 public:
  Attraction() = default;
  /// @throws SetupError for a number out of range
  explicit Attraction(const AttractionLimits& limits, bool soft_start = false);

  /// f(d) [N] or [N m], for d >= 0; 0 below.
  [[nodiscard]] double force(double d) const noexcept;

  /// U(d) [J], 0 to `depth`.
  [[nodiscard]] double energy(double d) const noexcept;

  /// Share of the damping at that distance, 0 to 1. It follows the slope of the force, so damping
  /// that is stable at the stiffest point is stable everywhere.
  [[nodiscard]] double damping_share(double d) const noexcept;

  /// P [N] or [N m], the greatest force.
  [[nodiscard]] double peak() const noexcept { return peak_; }
  /// Distance from which on there is no force [m] or [rad].
  [[nodiscard]] double border() const noexcept { return range_ + 0.5 * start_; }
  /// U beyond the border [J]: the energy to leave.
  [[nodiscard]] double depth() const noexcept { return energy(border()); }
  /// [N/m], [N m/rad] at the centre.
  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }

 private:
  // U(r) = 3/4 P r - 13/24 P^2 / k
  [[nodiscard]] double peak_within(double most_force, double most_energy) const noexcept;
  /// How much more than the spring from its distance of zero the soft start stores [J].
  [[nodiscard]] double lead() const noexcept { return stiffness_ * start_ * start_ / 24.0; }

  [[nodiscard]] double of_spring(double d) const noexcept;
  [[nodiscard]] double of_integral(double d) const noexcept;
  [[nodiscard]] double faded(double d) const noexcept;

  double stiffness_ = 0.0;
  double range_ = 0.0;  // r of the spring
  double peak_ = 0.0;
  double start_ = 0.0;  // e
};

/// The largest share of `damper`, up to 1, with |spring + share damper| at most `most`; 0 if the
/// spring alone is larger. [N] or [N m]
[[nodiscard]] double share_within(const Vec3& spring, const Vec3& damper, double most) noexcept;

}  // namespace repel::network
