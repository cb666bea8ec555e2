// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Engines dividing a mesh into convex parts. Set-up only: it allocates.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "polytope.hpp"
#include "solid.hpp"

namespace repel::cover {

/// Parts from an engine: their hulls approximate the solid, some of its surface may be in none.
using PointSets = std::vector<std::vector<Vec3>>;

/// Cuts the surface by planes, always at the largest excess of a part over the solid, until the
/// excess is at most `error` [m] or there are `most` parts. Of the planes of the mesh and of the
/// axes, the one leaving the least volume of the hulls is taken. Covers the surface exactly.
[[nodiscard]] PointSets cut_by_planes(const Solid& solid, int most, double error, double thickness,
                                      const std::function<void(const std::string&)>& progress);

/// The shared library of the PyPI package `coacd`: $REPEL_COACD, or where python3 finds it; empty
/// if there is none.
[[nodiscard]] std::string coacd_library();

/// CoACD (X. Wei et al., "Approximate convex decomposition for 3D meshes with collision-aware
/// concavity and tree search", 2022) through the C functions of that library.
/// @param threshold of its concavity, 0.01 to 1; smaller: more parts
/// @throws SetupError if the library cannot be loaded or finds no parts
[[nodiscard]] PointSets coacd_parts(const Solid& solid, const std::string& library,
                                    double threshold, int most);

/// HACD (K. Mamou and F. Ghorbel, "A simple and efficient approach for 3D mesh approximate convex
/// decomposition", 2009): joins triangles to clusters while these are less concave than asked for.
/// @param concavity [m] of a part at most, as HACD measures it
/// @throws SetupError if it is not built in, for too many triangles, or if it finds no parts
[[nodiscard]] PointSets hacd_parts(const Solid& solid, double concavity);

}  // namespace repel::cover
