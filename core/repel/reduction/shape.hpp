// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Convex shapes: the interface for users.
#pragma once

#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/facets.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/reduction/hull_ladder.hpp>

namespace repel::detail {

/// See Shape::hull and Shape::reduced.
template <>
struct HullBuilding<ReductionOptions> {
  static Shape shape(std::span<const Vec3> points, const ReductionOptions& options) {
    checked("number of points", static_cast<double>(points.size()), 1.0, 10000.0, "");
    for (const Vec3& p : points) {
      for (int axis = 0; axis < 3; ++axis) {
        checked("coordinate", p[axis], -Shape::largest, Shape::largest, "m");
      }
    }
    const std::vector<Facet> facets = hull_facets(points);
    const double radius = hull_inscribed_radius(points, facets);
    return Shape(hull_ladder(points, Shape::allowed(options), facets),
                 hull_planes(points, facets, radius), options, radius);
  }
  static Ladder ladder(const Convex& hull, const ReductionOptions& options) {
    return hull_ladder(hull, options);
  }
};

}  // namespace repel::detail
