// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A convex set rotated into world axes.
#pragma once

#include <array>
#include <cstdint>

#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// The support map of a set in world axes around the origin of the set, for a search with several
/// evaluations. Some sets are rotated once in advance, to rotate neither the direction nor the
/// result: the edges of a box (three of them sum to a corner), and the vertices of a small
/// polytope.
class Turned {
 public:
  struct Point {
    std::uint32_t name;  ///< as in Convex::Point
    Vec<double> p;       ///< [m] world axes
  };

  /// Both arguments must outlive the object.
  Turned(const Convex& set, const Pose& X) noexcept
      : set_(set), X_(X), is_box_(set.kind() == Convex::Kind::box) {
    if (is_box_) {
      const Vec<double> half = set.half_extents();
      edges_ = {half.x() * column<double>(X, 0), half.y() * column<double>(X, 1),
                half.z() * column<double>(X, 2)};
    } else if (set.is_scanned()) {
      vertices_ = set.vertices().turned(X, room_.data());
    }
  }
  // `vertices_` refers to `room_`.
  Turned(const Turned&) = delete;
  Turned& operator=(const Turned&) = delete;

  /// The farthest point along `d` (of any length); one of several equally far within rounding.
  [[nodiscard]] Point support(const Vec<double>& d) const noexcept {
    if (is_box_) {
      const Vec<double> d_own = rotate_transposed(X_, d);
      return {set_.corner_name(~minus_signs(d_own)),
              sum_along(edges_[0], edges_[1], edges_[2], d_own)};
    }
    if (vertices_.stride != 0) {
      const std::uint32_t i = vertices_.farthest(d);
      return {i, vertices_.vertex(i)};
    }
    return turned(set_.support(rotate_transposed(X_, d)));
  }
  [[nodiscard]] Point point(std::uint32_t name) const noexcept { return turned(set_.point(name)); }

 private:
  [[nodiscard]] Point turned(const Convex::Point<double>& point) const noexcept {
    return {point.name, rotate(X_, point.p)};
  }

  const Convex& set_;
  const Pose& X_;
  bool is_box_;
  std::array<Vec<double>, 3> edges_;  ///< [m] half edges
  std::array<double, 3 * Convex::largest_scan> room_;
  VertexBlock vertices_;
};

}  // namespace repel::detail
