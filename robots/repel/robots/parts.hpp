// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Converts the convex parts of a robot to shapes.
#pragma once

#include <repel/reduction/shape.hpp>
#include <repel/robots/urdf.hpp>

namespace repel {

/// The shape of `part`, in its own frame.
/// @throws SetupError if its sizes are out of range
[[nodiscard]] inline Shape shape_of(const RobotPart& part, const ReductionOptions& options = {}) {
  switch (part.kind) {
    case PartKind::box:
      return Shape::box(part.size, options);
    case PartKind::sphere:
      return Shape::sphere(part.size.x(), options);
    case PartKind::capsule:
      return Shape::capsule(part.size.x(), part.size.y(), options);
    case PartKind::cylinder:
      return Shape::cylinder(part.size.x(), part.size.y(), options);
    case PartKind::ellipsoid:
      return Shape::ellipsoid(part.size, options);
    case PartKind::hull:
      return Shape::hull(part.points, options);
  }
  throw SetupError("part '" + part.name + "' is of no kind");
}

}  // namespace repel
