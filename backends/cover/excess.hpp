// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How far convex parts reach out of a solid: a proven bound.
#pragma once

#include <functional>
#include <span>

#include "polytope.hpp"
#include "solid.hpp"

namespace repel::cover {

/// Distances of points of a part from the solid [m].
struct Excess {
  double bound = 0.0;    ///< no point of the part is farther
  double reached = 0.0;  ///< a point that is this far
  Vec3 at{0, 0, 0};      ///< that point; meaningless if `reached` is 0
};

struct ExcessOptions {
  double gap = 1e-4;          ///< [m] between `bound` and `reached` at which the search is content
  double enough = 1e300;      ///< [m] the search ends when `reached` is larger
  int most_pieces = 400'000;  ///< after so many it ends with the bound reached
};

/// The excess of the hull of a part: branch and bound over pieces of it. A piece is bounded by the
/// farthest of its corners from one triangle, as the distance from a convex set is largest at a
/// corner. A piece crossed by the surface is first divided by the planes of the triangles, and its
/// share inside the solid does not count.
[[nodiscard]] Excess excess_of(const ConvexPart& part, const Solid& solid,
                               const ExcessOptions& options);

/// The mean distance of the surface of all parts together from the solid [m]: of points on facets
/// that are in no other part, drawn evenly by a fixed seed.
[[nodiscard]] double mean_excess(std::span<const ConvexPart> parts, const Solid& solid,
                                 int samples);

}  // namespace repel::cover
