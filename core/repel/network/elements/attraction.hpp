// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force towards a virtual fixture as a function of the distance from it, with its potential.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>
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
/// P is F, at most k r / 3, and such that U(r) is at most E. So f has a continuous slope, whose
/// size is nowhere more than k, and so has f(d) / d, the stiffness across. U is its integral from
/// 0.
///
/// With a soft start, for the outside of a tube or a cone, the slope begins at zero as well: f(d) =
/// k d^2 / (2 e) up to d = e, a tenth of the range or a / 2 if that is less, and goes on as above.
class Attraction {
 public:
  Attraction() = default;
  /// @throws SetupError for a number out of range
  explicit Attraction(const AttractionLimits& limits, bool soft_start = false)
      : stiffness_(checked("stiffness", limits.stiffness, 0.0, 1e7, "N/m or N m/rad")) {
    checked("most force", limits.most_force, 1e-9, 1e6, "N or N m");
    checked("range", limits.range, 1e-6, 1e3, "m or rad");
    checked("most energy", limits.most_energy, 1e-9, 1e6, "J");
    if (stiffness_ == 0.0) return;
    range_ = limits.range;
    peak_ = peak_within(limits.most_force, limits.most_energy);
    if (!soft_start) return;
    start_ = std::min(0.1 * range_, 0.5 * peak_ / stiffness_);
    range_ -= 0.5 * start_;
    peak_ = peak_within(limits.most_force, limits.most_energy - lead());
  }

  /// f(d) [N] or [N m], for d >= 0; 0 below.
  [[nodiscard]] double force(double d) const noexcept {
    if (!(d > 0.0) || d >= border()) return 0.0;
    if (d < start_) return 0.5 * stiffness_ * d * d / start_;
    return of_spring(d - 0.5 * start_);
  }

  /// U(d) [J], 0 to `depth`.
  [[nodiscard]] double energy(double d) const noexcept {
    if (!(d > 0.0)) return 0.0;
    if (d < start_) return stiffness_ * d * d * d / (6.0 * start_);
    return lead() + of_integral(d - 0.5 * start_);
  }

  /// Share of the damping that belongs to the distance, 0 to 1: it comes and goes with the slope of
  /// the force, so that what keeps the spring stable at its stiffest does so everywhere.
  [[nodiscard]] double damping_share(double d) const noexcept {
    if (d >= border() || stiffness_ == 0.0) return 0.0;
    if (d < start_) return std::max(0.0, d / start_);
    return faded(d - 0.5 * start_);
  }

  /// P [N] or [N m], the greatest force.
  [[nodiscard]] double peak() const noexcept { return peak_; }
  /// Distance from which on there is no force [m] or [rad].
  [[nodiscard]] double border() const noexcept { return range_ + 0.5 * start_; }
  /// U beyond the border [J]: what it takes to leave.
  [[nodiscard]] double depth() const noexcept { return energy(border()); }
  /// [N/m], [N m/rad] at the centre.
  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }

 private:
  // U(r) = 3/4 P r - 13/24 P^2 / k
  [[nodiscard]] double peak_within(double most_force, double most_energy) const noexcept {
    const double square = 13.0 / 24.0 / stiffness_;
    const double linear = 0.75 * range_;
    const double most = std::min(most_force, stiffness_ * range_ / 3.0);
    if (linear * most - square * most * most <= most_energy) return most;
    const double root = std::sqrt(linear * linear - 4.0 * square * most_energy);
    return 2.0 * most_energy / (linear + root);
  }
  /// How much more than the spring from its distance of zero the soft start stores [J].
  [[nodiscard]] double lead() const noexcept { return stiffness_ * start_ * start_ / 24.0; }

  [[nodiscard]] double of_spring(double d) const noexcept {
    const double a = peak_ / stiffness_;
    if (d <= 0.5 * a) return stiffness_ * d;
    const double over = d - 0.5 * a;
    if (d <= 1.5 * a) return stiffness_ * (d - over * over / (2.0 * a));
    return peak_ * faded(d);
  }
  [[nodiscard]] double of_integral(double d) const noexcept {
    if (stiffness_ == 0.0) return 0.0;
    const double a = peak_ / stiffness_;
    const double straight = std::min(d, 1.5 * a);
    const double over = std::max(0.0, straight - 0.5 * a);
    double sum = stiffness_ * (0.5 * straight * straight - over * over * over / (6.0 * a));
    if (d <= 1.5 * a) return sum;
    const double half = 0.5 * range_;
    sum += peak_ * (std::min(d, half) - 1.5 * a);
    if (d <= half) return sum;
    const double t = std::min(1.0, (d - half) / half);
    return sum + peak_ * half * (t - t * t * t + 0.5 * t * t * t * t);
  }
  [[nodiscard]] double faded(double d) const noexcept {
    const double half = 0.5 * range_;
    const double t = std::clamp((d - half) / half, 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
  }

  double stiffness_ = 0.0;
  double range_ = 0.0;  // r of the spring
  double peak_ = 0.0;
  double start_ = 0.0;  // e
};

/// The largest share of `damper`, up to 1, for which spring + share damper is at most `most` long;
/// 0 where the spring alone is longer. [N] or [N m]
[[nodiscard]] inline double share_within(const Vec3& spring, const Vec3& damper,
                                         double most) noexcept {
  const double a = squared_norm(damper);
  const double b = dot(spring, damper);
  const double c = std::min(0.0, squared_norm(spring) - most * most);
  if (a + 2.0 * b + c <= 0.0) return 1.0;
  return std::clamp((std::sqrt(std::max(0.0, b * b - a * c)) - b) / a, 0.0, 1.0);
}

}  // namespace repel::network
