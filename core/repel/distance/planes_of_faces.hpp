// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The planes of the faces of a polytope, one by one or in SIMD lanes.
#pragma once

#include <algorithm>
#include <bit>

#include <repel/base/lanes.hpp>
#include <repel/base/vec.hpp>

namespace repel::detail {

/// The plane of a triangle.
struct FacePlane {
  Vec<double> n{};      ///< [m^2] counter-clockwise seen from its tip; zero when there is none
  double offset = 0.0;  ///< [m^3] the largest product of n and a corner
};

/// The plane through three points, with these within `margin` [m] of it: its bound of the distance
/// holds for all points of the triangle. In double precision the normal of a sliver turns by
/// rounding; it is then found in extended precision.
[[nodiscard]] inline FacePlane plane_through(const Vec<double>& p, const Vec<double>& q,
                                             const Vec<double>& r, double margin) noexcept {
  Vec<double> n = cross(q - p, r - p);
  for (const bool last : {false, true}) {
    const Vec<double> products = dots(p, q, r, n);
    const auto [least, most] = std::minmax({products.x(), products.y(), products.z()});
    if ((most - least) * (most - least) <= margin * margin * dot(n, n)) return {n, most};
    if (last) break;
    const Vec<DoubleDouble> from(p);
    n = Vec<double>(cross(Vec<DoubleDouble>(q) - from, Vec<DoubleDouble>(r) - from));
  }
  return {};
}

/// The planes of four triangles.
struct LanePlanes {
  LaneVec n;     ///< unit, outward
  Lanes offset;  ///< [m]
};

/// `plane_through` for four triangles at once, its normals made unit vectors; not a number where
/// there is none.
[[nodiscard]] inline LanePlanes planes_through(const LaneVec& p, const LaneVec& q, const LaneVec& r,
                                               double margin) noexcept {
  LaneVec n = cross(q - p, r - p);
  const Lanes at_p = dot(p, n);
  const Lanes at_q = dot(q, n);
  const Lanes at_r = dot(r, n);
  Lanes offset = larger(larger(at_p, at_q), at_r);
  const Lanes off = offset - smaller(smaller(at_p, at_q), at_r);
  unsigned slivers = bits_of(~(off * off <= margin * margin * dot(n, n)));
  for (; slivers != 0U; slivers &= slivers - 1U) {
    const int k = std::countr_zero(slivers);
    const auto corner = [k](const LaneVec& v) { return Vec<double>(v.at(k)); };
    const FacePlane plane = plane_through(corner(p), corner(q), corner(r), margin);
    n.set(k, plane.n);
    offset[k] = plane.offset;
  }
  const Lanes per_length = 1.0 / roots(dot(n, n));
  return {per_length * n, per_length * offset};
}

}  // namespace repel::detail
