// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parts that reach into each other, and how far. Set-up only: it allocates.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "polytope.hpp"
#include "solid.hpp"

namespace repel::cover {

/// Moves the facets of a part inside the solid outward by `overlap` [m]. They move less if the
/// excess over the solid would exceed `error` [m] and its present value.
[[nodiscard]] ConvexPart grown(const ConvexPart& part, const Solid& solid, double overlap,
                               double error);

/// The depth of the seams [m], by search. It is the least depth of a point in its deepest part,
/// over the points more than twice as deep in the solid. A lesser depth is felt by at least half: F
/// >= min(D / 2, seam), with D the depth in the solid and F that in the deepest part. (At a concave
/// edge of 90 degrees F = D / sqrt(2), however far the parts reach.) The largest depth seen if
/// there is no such point; none if no facet lies within another part. Points are drawn near such
/// facets by a fixed seed, and the least ones are followed: an estimate from above.
/// @param samples to draw
[[nodiscard]] std::optional<double> seam_depth(const Solid& solid,
                                               std::span<const ConvexPart> parts, double overlap,
                                               int samples);

}  // namespace repel::cover
