// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The distance of a point from the surface of an ellipsoid in 113-bit arithmetic, by bisection of
/// the secular equation.
#pragma once

#include <algorithm>
#include <cmath>

#include <support/quad.hpp>

namespace repel::oracle {

/// [m] Distance of `p` from the surface; negative inside. The nearest point has the parts
/// a^2 p / (t + a^2) with the largest t at which it lies on the surface.
inline Real distance_from_ellipsoid(const Vec3& semi_axes, const Point& p) {
  Real low = -Real(semi_axes.minCoeff()) * Real(semi_axes.minCoeff());
  const Real pole = low;
  Real high = Real(semi_axes.maxCoeff()) * square_root(dot(p, p));
  Point a{{semi_axes.x(), semi_axes.y(), semi_axes.z()}};
  const auto on_surface = [&](Real t) {
    Point q{};
    for (int k = 0; k < 3; ++k) {
      const Real under = t + a.x[k] * a.x[k];
      q.x[k] = under > 0 ? a.x[k] * a.x[k] * p.x[k] / under : Real(0);
    }
    return q;
  };
  const auto is_outside = [&](const Point& q) {
    Real sum = 0;
    for (int k = 0; k < 3; ++k) sum += q.x[k] / a.x[k] * (q.x[k] / a.x[k]);
    return sum > 1;
  };
  for (int step = 0; step < 240 && low < high; ++step) {
    // Near the pole, steps in proportion to the distance from it.
    const Real middle = step % 2 == 0
                            ? (low + high) / 2
                            : pole + square_root((low - pole + Real(1e-60)) * (high - pole));
    (is_outside(on_surface(middle)) ? low : high) = middle;
  }
  Point q = on_surface(high);
  // In a plane of symmetry, the rest of the way to the surface is along the least axis.
  Real rest = 1;
  int thin = 0;
  for (int k = 0; k < 3; ++k) {
    rest -= q.x[k] / a.x[k] * (q.x[k] / a.x[k]);
    if (a.x[k] < a.x[thin]) thin = k;
  }
  if (rest > Real(1e-20)) q.x[thin] = a.x[thin] * square_root(rest);
  const Point between = p - q;
  const Real distance = square_root(dot(between, between));
  return is_outside(p) ? distance : -distance;
}

}  // namespace repel::oracle
