/// @file
/// The exact penetration depth of two boxes: the least overlap over the 15 axes that can separate
/// them (Gottschalk, Lin, Manocha 1996), in 113-bit arithmetic.
#pragma once

#include <support/oracle.hpp>

namespace repel::oracle {

/// [m] positive in overlap; not positive when some axis separates the boxes.
inline double penetration_depth(const Vec3& half_a, const Pose& X_WA, const Vec3& half_b,
                                const Pose& X_WB) {
  const auto axis_of = [](const Pose& X, int k) {
    return Point{{X.linear()(0, k), X.linear()(1, k), X.linear()(2, k)}};
  };
  Point between{};
  for (int i = 0; i < 3; ++i) between.x[i] = Real(X_WB.translation()[i]) - X_WA.translation()[i];
  Real least = Real(1e300);
  const auto try_axis = [&](Point n) {
    const Real length = square_root(dot(n, n));
    if (length < Real(1e-12)) return;
    Real reach = 0;
    for (int k = 0; k < 3; ++k) {
      reach += half_a[k] * magnitude(dot(axis_of(X_WA, k), n));
      reach += half_b[k] * magnitude(dot(axis_of(X_WB, k), n));
    }
    const Real overlap = (reach - magnitude(dot(between, n))) / length;
    least = overlap < least ? overlap : least;
  };
  for (int i = 0; i < 3; ++i) {
    const Point a = axis_of(X_WA, i);
    try_axis(a);
    try_axis(axis_of(X_WB, i));
    for (int j = 0; j < 3; ++j) {
      const Point b = axis_of(X_WB, j);
      try_axis({{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
                 a.x[0] * b.x[1] - a.x[1] * b.x[0]}});
    }
  }
  return static_cast<double>(least);
}

}  // namespace repel::oracle
