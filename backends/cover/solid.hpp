// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The solid bounded by a mesh. Set-up only: it allocates.
#pragma once

#include <string>
#include <vector>

#include <repel/geometry/triangle_mesh.hpp>

#include "box_hierarchy.hpp"
#include "polytope.hpp"

namespace repel::cover {

/// The defects of a mesh file, as the surface of a solid.
struct MeshFaults {
  std::size_t not_finite = 0;    ///< triangles with a corner not finite or missing
  std::size_t without_area = 0;  ///< triangles
  std::size_t duplicates = 0;    ///< triangles that are there twice
  std::size_t turned = 0;        ///< triangles facing against their neighbours
  std::size_t closed_holes = 0;  ///< holes that were closed
  std::size_t open_edges = 0;    ///< edges left without an opposite
  bool is_inside_out = false;    ///< all triangles face inward

  /// A sentence for each fault; empty without any.
  [[nodiscard]] std::vector<std::string> sentences() const;
};

/// A surface and, if it is closed, its inside: the points it winds around at least once. Its
/// triangles with area, turned the same way; small holes are closed.
class Solid {
 public:
  /// @param widest_hole [m] holes with all points at most this far from their rim are closed
  /// @throws SetupError if no triangle is left
  Solid(const TriangleMesh& mesh, double widest_hole);

  [[nodiscard]] const BoxHierarchy& surface() const { return surface_; }
  /// The triangles as in the file, but for those without numbers.
  [[nodiscard]] const std::vector<Triangle>& as_given() const { return as_given_; }
  [[nodiscard]] const MeshFaults& faults() const { return faults_; }
  [[nodiscard]] bool is_closed() const { return faults_.open_edges == 0; }
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  [[nodiscard]] double size() const { return (bounds_.high - bounds_.low).norm(); }  ///< [m]

  /// Whether p is inside; of an open surface nothing is.
  [[nodiscard]] bool has_inside(const Vec3& p) const {
    return is_closed() && surface_.winding_number(p) > 0;
  }
  /// The distance of p from the solid, 0 inside [m].
  [[nodiscard]] double distance(const Vec3& p) const {
    return has_inside(p) ? 0.0 : surface_.nearest(p).distance;
  }

 private:
  std::vector<Triangle> repaired(const TriangleMesh& mesh, double widest_hole);

  MeshFaults faults_;
  std::vector<Triangle> as_given_;
  Bounds bounds_;
  BoxHierarchy surface_;
};

}  // namespace repel::cover
