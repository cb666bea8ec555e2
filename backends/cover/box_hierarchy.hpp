// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Triangles in a tree of boxes. Set-up only: it allocates.
#pragma once

#include <array>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::cover {

using Triangle = std::array<Vec3, 3>;

/// An axis-aligned box [m].
struct Bounds {
  Vec3 low = Vec3::Constant(1e300);
  Vec3 high = Vec3::Constant(-1e300);

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] bool meets(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  [[nodiscard]] double squared_distance(const Vec3& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
  }
};

/// A binary tree over triangles, in an array: the first child of a node follows it.
class BoxHierarchy {
 public:
  explicit BoxHierarchy(std::vector<Triangle> triangles);

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

  struct Nearest {
    double distance = 1e300;  ///< [m]
    int triangle = -1;        ///< -1: there is none
  };
  /// The triangle nearest to p. Cost: about log n.
  [[nodiscard]] Nearest nearest(const Vec3& p) const;

  /// Writes the triangles whose boxes meet `box` to `found`. Returns false, and stops, after
  /// `most`.
  bool overlapping(const Bounds& box, std::size_t most, std::vector<int>& found) const;

  /// How often the surface winds around p: for a closed surface without self-intersections 1
  /// inside and 0 outside, if its outside sees the triangles counter-clockwise. Counts the
  /// crossings of a ray, of another one if it meets an edge. 0 where none of many rays avoids the
  /// edges. Meaningless for a surface that is not closed.
  [[nodiscard]] int winding_number(const Vec3& p) const;

 private:
  struct Node {
    Bounds box;
    int second = 0;  ///< index of the second child; of a leaf: 0
    int first = 0;   ///< of a leaf: its triangles
    int count = 0;
  };
  static constexpr int leaf_size = 4;

  int build(int first, int last, std::vector<Vec3>& middles);
  /// Calls see(index of a triangle) for all in boxes that `meets` accepts, until it returns false;
  /// then so does this.
  template <class Meets, class See>
  bool visit(const Meets& meets, const See& see) const;
  struct Crossings {
    int count = 0;
    bool is_doubtful = false;  ///< an edge is too near
  };
  [[nodiscard]] Crossings crossings(const Vec3& p, const Vec3& direction) const;

  std::vector<Triangle> triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace repel::cover
