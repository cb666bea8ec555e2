// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bounding volume hierarchy of static boxes: finds those near another box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/types.hpp>

namespace repel {

/// An axis-aligned box of a frame, between two corners [m].
class Box {
 public:
  /// Empty: it contains no point until it is extended.
  Box() = default;
  /// A point.
  explicit Box(const Vec3& p) : min_(p), max_(p) {}
  /// The corners with the least and the greatest coordinates.
  Box(const Vec3& min, const Vec3& max) : min_(min), max_(max) {}

  [[nodiscard]] const Vec3& min() const noexcept { return min_; }  ///< the least coordinates
  [[nodiscard]] const Vec3& max() const noexcept { return max_; }  ///< the greatest ones
  [[nodiscard]] Vec3& min() noexcept { return min_; }              ///< to be changed
  [[nodiscard]] Vec3& max() noexcept { return max_; }              ///< to be changed

  /// The smallest box around this one and another.
  Box& extend(const Box& other) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      min_[axis] = std::min(min_[axis], other.min_[axis]);
      max_[axis] = std::max(max_[axis], other.max_[axis]);
    }
    return *this;
  }
  /// The smallest box around this one and a point.
  Box& extend(const Vec3& p) noexcept { return extend(Box(p)); }

  /// The point is inside or on the boundary.
  [[nodiscard]] bool contains(const Vec3& p) const noexcept {
    return min_[0] <= p[0] && min_[1] <= p[1] && min_[2] <= p[2] && p[0] <= max_[0] &&
           p[1] <= max_[1] && p[2] <= max_[2];
  }

 private:
  static constexpr double far = std::numeric_limits<double>::max();
  Vec3 min_{far, far, far};
  Vec3 max_{-far, -far, -far};
};

/// The centre of `box` [m], as a plain vector.
[[nodiscard]] inline Vec3 centre(const Box& box) noexcept {
  return (box.min() + box.max()) / 2.0;
}
/// The size of `box` along each axis [m].
[[nodiscard]] inline Vec3 extents(const Box& box) noexcept {
  return box.max() - box.min();
}

/// A static 4-ary tree over boxes of one frame. Each node stores up to four child boxes side by
/// side, each around a quarter of the boxes of the node: one step of a query compares all four.
class BoxTree {
 public:
  BoxTree() = default;
  /// @param boxes [m] none empty; queries report their indices. Allocates.
  explicit BoxTree(std::span<const Box> boxes) {
    std::vector<std::int32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(boxes.size() / 2 + 1);
    if (boxes.empty()) return;
    std::vector<Task> open{{add_node(), {order.data(), order.size()}}};
    while (!open.empty()) {
      const Task task = open.back();
      open.pop_back();
      const auto [low, high] = halves(boxes, task.range);
      const auto [first, second] = halves(boxes, low);
      const auto [third, fourth] = halves(boxes, high);
      int lane = 0;
      for (const Range quarter : {first, second, third, fourth}) {
        if (quarter.empty()) continue;
        const bool leaf = quarter.size() == 1;
        const std::int32_t link = leaf ? ~quarter.front() : add_node();
        nodes_[task.node].set(lane++, around(boxes, quarter), link);
        if (!leaf) open.push_back({link, quarter});
      }
    }
    nodes_ = std::vector<Node>(nodes_);  // a copy holds no more memory than it needs
  }

  /// Calls `found(index, distance)` for every box at most `within` [m] (up to 1e9) from `box`, and
  /// for some up to a millionth farther; the reported distance [m] is a lower bound. In the order
  /// of the tree. Returns a lower bound of the distance of all other boxes [m], up to 1e18. Cost:
  /// about 10 ns per node visited. No heap; bounded by the number of boxes.
  template <class Found>
  double query(const Box& box, double within, Found&& found) const noexcept {
    const Node::Probe probe(box);
    const auto least = static_cast<float>(within);
    float others = farthest;
    std::array<std::int32_t, most_open> open;
    int count = 0;
    if (!nodes_.empty()) open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[open[--count]];
      const Floats distances = node.distances(probe);
      for (int lane = 0; lane < 4; ++lane) {
        const float distance = distances[lane];
        const std::int32_t link = node.links[lane];
        if (distance > least) {
          others = std::min(others, distance);
        } else if (link >= 0) {
          open[count++] = link;
        } else {
          found(~link, static_cast<double>(distance));
        }
      }
    }
    return others;
  }

  /// [bytes] of heap that the nodes take.
  [[nodiscard]] std::size_t bytes() const noexcept { return nodes_.capacity() * sizeof(Node); }

 private:
  using Range = std::span<std::int32_t>;
  struct Task {
    std::int32_t node;
    Range range;
  };

  static constexpr float farthest = 1e18F;          ///< [m] its square still fits in a float
  static constexpr float inward = 1.0F - 0x1p-20F;  ///< covers all rounding of a distance
  /// Stack size: a node leaves three of its four children pending, on each of the 16 levels that
  /// 2^31 boxes can have.
  static constexpr int most_open = 3 * 17 + 1;

  using Floats = float __attribute__((vector_size(16)));

  /// Boxes in single precision, rounded outward.
  struct alignas(64) Node {
    /// A box against which the boxes of a node are compared, copied to every lane.
    struct Probe {
      /// Rounded outwards to float.
      explicit Probe(const Box& box) {
        for (int axis = 0; axis < 3; ++axis) {
          lower[axis] = below(box.min()[axis]) - Floats{};
          upper[axis] = -below(-box.max()[axis]) - Floats{};
        }
      }
      std::array<Floats, 3> lower;  ///< [m] of each axis, the same in every lane
      std::array<Floats, 3> upper;  ///< likewise
    };

    void set(int lane, const Box& box, std::int32_t link) {
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis][lane] = below(box.min()[axis]);
        upper[axis][lane] = -below(-box.max()[axis]);
      }
      links[lane] = link;
    }

    [[nodiscard]] Floats distances(const Probe& probe) const noexcept {
      Floats squares{};
      for (int axis = 0; axis < 3; ++axis) {
        const Floats before = lower[axis] - probe.upper[axis];
        const Floats behind = probe.lower[axis] - upper[axis];
        const Floats apart = before > behind ? before : behind;
        const Floats gap = apart > 0.0F ? apart : Floats{};
        squares += gap * gap;
      }
      const Floats distances = roots(squares) * inward;
      return distances < farthest ? distances : farthest - Floats{};
    }

    // A lane without a box is farther than any query distance.
    std::array<Floats, 3> lower = all(3.0F * farthest);
    std::array<Floats, 3> upper = all(3.0F * farthest);
    std::array<std::int32_t, 4> links{};  ///< index of a child node, or ~index of a box

   private:
    static std::array<Floats, 3> all(float value) {
      const Floats four = value - Floats{};
      return {four, four, four};
    }
    /// The square roots of Eigen, which are faster but not correctly rounded.
    static Floats roots(const Floats& squares) noexcept {
      Eigen::Array4f four;
      std::memcpy(four.data(), &squares, sizeof squares);
      four = four.sqrt();
      Floats roots;
      std::memcpy(&roots, four.data(), sizeof roots);
      return roots;
    }
  };

  /// A lower bound of x, by a few rounding errors.
  [[nodiscard]] static float below(double x) noexcept {
    const auto rounded = static_cast<float>(std::clamp<double>(x, -farthest, farthest));
    return rounded - (std::abs(rounded) * 0x1p-22F + std::numeric_limits<float>::min());
  }

  std::int32_t add_node() {
    nodes_.emplace_back();
    return static_cast<std::int32_t>(nodes_.size()) - 1;
  }

  [[nodiscard]] static Box around(std::span<const Box> boxes, Range range) {
    Box all;
    for (const std::int32_t i : range) all.extend(boxes[i]);
    return all;
  }

  /// Splits `range` into halves of equal count, along the axis on which the centres spread most.
  [[nodiscard]] static std::pair<Range, Range> halves(std::span<const Box> boxes, Range range) {
    const std::size_t half = (range.size() + 1) / 2;
    if (range.size() > 1) {
      Box centres;
      for (const std::int32_t i : range) centres.extend(centre(boxes[i]));
      const Vec3 spread = extents(centres);
      int axis = spread[1] > spread[0] ? 1 : 0;
      if (spread[2] > spread[axis]) axis = 2;
      std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(half),
                       range.end(), [&](std::int32_t i, std::int32_t j) {
                         const double a = centre(boxes[i])[axis], b = centre(boxes[j])[axis];
                         return a < b || (a == b && i < j);
                       });
    }
    return {range.first(half), range.subspan(half)};
  }

  std::vector<Node> nodes_;
};

}  // namespace repel
