// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/attraction.hpp>

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Attraction::Attraction(const AttractionLimits& limits, bool soft_start)
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

double Attraction::force(double d) const noexcept {
  if (!(d > 0.0) || d >= border()) return 0.0;
  if (d < start_) return 0.5 * stiffness_ * d * d / start_;
  return of_spring(d - 0.5 * start_);
}

double Attraction::energy(double d) const noexcept {
  if (!(d > 0.0)) return 0.0;
  if (d < start_) return stiffness_ * d * d * d / (6.0 * start_);
  return lead() + of_integral(d - 0.5 * start_);
}

double Attraction::damping_share(double d) const noexcept {
  if (d >= border() || stiffness_ == 0.0) return 0.0;
  if (d < start_) return std::max(0.0, d / start_);
  return faded(d - 0.5 * start_);
}

double Attraction::peak_within(double most_force, double most_energy) const noexcept {
  const double square = 13.0 / 24.0 / stiffness_;
  const double linear = 0.75 * range_;
  const double most = std::min(most_force, stiffness_ * range_ / 3.0);
  if (linear * most - square * most * most <= most_energy) return most;
  const double root = std::sqrt(linear * linear - 4.0 * square * most_energy);
  return 2.0 * most_energy / (linear + root);
}

double Attraction::of_spring(double d) const noexcept {
  const double a = peak_ / stiffness_;
  if (d <= 0.5 * a) return stiffness_ * d;
  const double over = d - 0.5 * a;
  if (d <= 1.5 * a) return stiffness_ * (d - over * over / (2.0 * a));
  return peak_ * faded(d);
}

double Attraction::of_integral(double d) const noexcept {
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

double Attraction::faded(double d) const noexcept {
  const double half = 0.5 * range_;
  const double t = std::clamp((d - half) / half, 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

double share_within(const Vec3& spring, const Vec3& damper, double most) noexcept {
  const double a = squared_norm(damper);
  const double b = dot(spring, damper);
  const double c = std::min(0.0, squared_norm(spring) - most * most);
  if (a + 2.0 * b + c <= 0.0) return 1.0;
  return std::clamp((std::sqrt(std::max(0.0, b * b - a * c)) - b) / a, 0.0, 1.0);
}

}  // namespace repel::network
