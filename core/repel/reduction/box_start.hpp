// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the search for the deepest common point of two boxes starts.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <repel/reduction/plane_basis.hpp>

namespace repel::detail {

/// A face of one box and the three faces of the other one at its corner below it, by their names.
struct BoxStart {
  unsigned side = 0;                      ///< which box the face is of: A (0) or B (1)
  std::uint32_t face = 0;                 ///< of that box
  std::array<std::uint32_t, 3> corner{};  ///< of the other one
};

/// Of all faces of two boxes, the one that the other box would leave soonest, and the corner of the
/// other box that would leave last: the deepest common point is mostly near. Cost: that of six
/// support functions.
/// @param tilt of the objective, in world axes: it decides for one of the corners of an edge or
/// face that is parallel
[[nodiscard]] inline BoxStart box_start(const PosedPlanes& A, const PosedPlanes& B,
                                        const Vec<double>& tilt) noexcept {
  const std::array<const PosedPlanes*, 2> boxes{&A, &B};
  const Vec<double> p_AB = column<double>(B.X_W, 3) - column<double>(A.X_W, 3);
  BoxStart start;
  double least = std::numeric_limits<double>::infinity();
  Vec<double> outward = Vec<double>();
  for (unsigned side = 0; side < 2; ++side) {
    const PosedPlanes& box = *boxes[side];
    const PosedPlanes& other = *boxes[1 - side];
    const Planes& of_other = other.planes;
    const Vec<double> half(of_other.offset(0), of_other.offset(2), of_other.offset(4));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const Vec<double> n = column<double>(box.X_W, static_cast<int>(axis));
      const double along = side == 0 ? dot(n, p_AB) : -dot(n, p_AB);
      const double overlap = box.planes.offset(2 * axis) - std::abs(along) +
                             dot(half, magnitudes(rotate_transposed(other.X_W, n)));
      if (!(overlap < least)) continue;
      least = overlap;
      outward = along < 0.0 ? -n : n;
      start.side = side;
      start.face = 2 * axis + (along < 0.0 ? 1U : 0U);
    }
  }
  const unsigned minus = minus_signs(rotate_transposed(boxes[1 - start.side]->X_W, tilt - outward));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    start.corner[axis] = 2 * axis + (minus >> axis & 1U);
  }
  return start;
}

}  // namespace repel::detail
