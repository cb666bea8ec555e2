// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The angle of a direction in a plane, of several at once.
#pragma once

#include <numbers>

#include <repel/base/lanes.hpp>

namespace repel::detail {

/// The angle [rad] from the x axis to (x, y), -pi to pi, to 1e-13; 0 for (0, 0). As std::atan2, in
/// every lane.
[[nodiscard]] inline Lanes turns_of(const Lanes& y, const Lanes& x) noexcept {
  const Lanes along = magnitudes(x);
  const Lanes across = magnitudes(y);
  const Lanes low = smaller(along, across);
  const Lanes high = larger(along, across);
  // Beyond an eighth of pi the angle is measured from the diagonal.
  const LaneMask past = low > (std::numbers::sqrt2 - 1.0) * high;
  const Lanes above = either(past, low - high, low);
  const Lanes below = either(past, low + high, high);
  const Lanes z = above / either(below > 0.0, below, all_of(1.0));
  // The polynomial that differs least from atan(z) / z, in u = z^2.
  const Lanes u = z * z;
  const Lanes u2 = u * u;
  const Lanes u4 = u2 * u2;
  const Lanes first = (0.99999999999997323166 - 0.33333333330803445908 * u) +
                      u2 * (0.19999999604891977988 - 0.14285690423839287162 * u);
  const Lanes second = (0.11110385046148013704 - 0.090783920729434234071 * u) +
                       u2 * (0.075637035519151919886 - 0.058745056213078307484 * u);
  const Lanes whole = z * (first + u4 * (second + u4 * 0.030662440370424448757));
  const Lanes none{};
  const Lanes from_axis = either(past, all_of(0.25 * std::numbers::pi), none) + whole;
  const Lanes quarter = either(across > along, 0.5 * std::numbers::pi - from_axis, from_axis);
  const Lanes half = either(x < 0.0, std::numbers::pi - quarter, quarter);
  return either(y < 0.0, -half, half);
}

}  // namespace repel::detail
