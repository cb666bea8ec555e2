// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The planes of the faces of a polytope, in SIMD lanes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

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

/// The planes of the faces of a closed polytope of triangles with at most that many corners, found
/// together.
template <std::size_t most_corners>
class PlanesOfFaces {
 public:
  void set(std::size_t f, const FacePlane& plane) noexcept {
    x_[f] = plane.n.x();
    y_[f] = plane.n.y();
    z_[f] = plane.n.z();
    offset_[f] = plane.offset;
  }
  /// Call when `count` faces are set. False where a face has no area, or an offset of at most
  /// `least` [m].
  [[nodiscard]] bool find(std::size_t count, double least) noexcept {
    for (std::size_t f = count; f % lane_count != 0; ++f) {
      x_[f] = x_[0];
      y_[f] = y_[0];
      z_[f] = z_[0];
      offset_[f] = offset_[0];
    }
    LaneMask beyond = Lanes{} == Lanes{};
    for (std::size_t f = 0; f < count; f += lane_count) {
      const LaneVec n{some(x_, f), some(y_, f), some(z_, f)};
      const Lanes part = 1.0 / roots(dot(n, n));
      const Lanes offset = part * some(offset_, f);
      beyond = beyond & (offset > all_of(least));
      store(part * n.x, x_, f);
      store(part * n.y, y_, f);
      store(part * n.z, z_, f);
      store(offset, offset_, f);
    }
    return bits_of(~beyond) == 0U;
  }
  /// Unit, outward.
  [[nodiscard]] Vec<double> normal(std::size_t f) const noexcept { return {x_[f], y_[f], z_[f]}; }
  [[nodiscard]] double offset(std::size_t f) const noexcept { return offset_[f]; }

 private:
  using Numbers =
      std::array<double, (2 * most_corners - 4 + lane_count - 1) / lane_count * lane_count>;
  [[nodiscard]] static Lanes some(const Numbers& numbers, std::size_t f) noexcept {
    Lanes lanes;
    std::memcpy(&lanes, numbers.data() + f, sizeof lanes);
    return lanes;
  }
  static void store(const Lanes& lanes, Numbers& numbers, std::size_t f) noexcept {
    std::memcpy(numbers.data() + f, &lanes, sizeof lanes);
  }

  Numbers x_, y_, z_;  ///< normals
  Numbers offset_;     ///< [m]
};

}  // namespace repel::detail
