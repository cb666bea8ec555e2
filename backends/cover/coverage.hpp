// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which points of a surface lie in none of the parts: by cutting, not by sampling.
#pragma once

#include <span>
#include <vector>

#include "box_hierarchy.hpp"
#include "polytope.hpp"

namespace repel::cover {

/// A piece of a triangle that is in no part.
struct Gap {
  Polygon polygon;     ///< [m]
  double depth = 0.0;  ///< [m] no point of it is farther from the nearest part
  int nearest = -1;    ///< the part of the bound; -1: there are no parts
};

/// Cuts each triangle by the planes of the parts. Points of the surface outside the returned pieces
/// are at most `margin` [m] from a part; the margin covers rounding.
[[nodiscard]] std::vector<Gap> gaps_in(std::span<const Triangle> surface,
                                       std::span<const ConvexPart> parts, double margin);

/// Lets parts grow until there are no gaps: each gap, or half of it, joins the nearest part. A gap
/// farther than `most` [m] from every part stays.
/// @param thickness as in ConvexPart::of
[[nodiscard]] std::vector<Gap> fill_gaps(std::span<const Triangle> surface,
                                         std::vector<ConvexPart>& parts, double margin, double most,
                                         double thickness);

}  // namespace repel::cover
