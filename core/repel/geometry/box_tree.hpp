/// @file
/// Which of many boxes that do not move are near another box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/types.hpp>

namespace repel {

/// Along the axes of a frame, between two corners [m].
using Box = Eigen::AlignedBox3d;

/// A tree over boxes of one frame, built once. In each node lie up to four boxes side by side, each
/// around a quarter of the node's: one step of a query compares all four.
class BoxTree {
 public:
  BoxTree() = default;
  /// @param boxes [m] none empty; their indices are what a query reports. Allocates.
  explicit BoxTree(std::span<const Box> boxes) {
    std::vector<std::int32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(boxes.size() / 2 + 1);
    if (boxes.empty()) return;
    std::vector<Task> open{{add_node(), order}};
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
    nodes_.shrink_to_fit();
  }

  /// Calls `found(index, distance)` for every box whose distance to `box` is no more than `within`
  /// [m], up to 1e9, and for some that are by a millionth farther; the distance reported [m] is
  /// never more than the true one. In the order of the tree.
  /// Returns what all others are at least away [m], up to 1e18.
  /// Cost: about 10 ns for each node it enters. No heap; bounded by the number of boxes.
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
      const Eigen::Array4f distances = node.distances(probe);
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

  [[nodiscard]] std::size_t bytes() const noexcept { return nodes_.capacity() * sizeof(Node); }

 private:
  using Range = std::span<std::int32_t>;
  struct Task {
    std::int32_t node;
    Range range;
  };

  static constexpr float farthest = 1e18F;          ///< [m] whose square a float still holds
  static constexpr float inward = 1.0F - 0x1p-20F;  ///< more than all roundings of a distance
  /// A node leaves three of its four to wait, on each of the 16 levels that 2^31 boxes can have.
  static constexpr int most_open = 3 * 17 + 1;

  /// Single precision, rounded outward.
  struct alignas(64) Node {
    struct Probe {
      explicit Probe(const Box& box) {
        for (int axis = 0; axis < 3; ++axis) {
          lower[axis] = Eigen::Array4f::Constant(below(box.min()[axis]));
          upper[axis] = Eigen::Array4f::Constant(-below(-box.max()[axis]));
        }
      }
      std::array<Eigen::Array4f, 3> lower, upper;
    };

    void set(int lane, const Box& box, std::int32_t link) {
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis][lane] = below(box.min()[axis]);
        upper[axis][lane] = -below(-box.max()[axis]);
      }
      links[lane] = link;
    }

    [[nodiscard]] Eigen::Array4f distances(const Probe& probe) const noexcept {
      Eigen::Array4f squares = Eigen::Array4f::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Array4f gap =
            (lower[axis] - probe.upper[axis]).max(probe.lower[axis] - upper[axis]).max(0.0F);
        squares += gap * gap;
      }
      return (squares.sqrt() * inward).min(farthest);
    }

    // A lane without a box is farther than anything asked for.
    std::array<Eigen::Array4f, 3> lower = all(3.0F * farthest);
    std::array<Eigen::Array4f, 3> upper = all(3.0F * farthest);
    std::array<std::int32_t, 4> links{};  ///< a node, or a box: ~ its index

   private:
    static std::array<Eigen::Array4f, 3> all(float value) {
      const Eigen::Array4f four = Eigen::Array4f::Constant(value);
      return {four, four, four};
    }
  };

  /// Less than x by no more than some roundings.
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

  /// Two ranges of as many boxes, apart along the axis on which their centres spread most.
  [[nodiscard]] static std::pair<Range, Range> halves(std::span<const Box> boxes, Range range) {
    const std::size_t half = (range.size() + 1) / 2;
    if (range.size() > 1) {
      Box centres;
      for (const std::int32_t i : range) centres.extend(boxes[i].center());
      Eigen::Index axis = 0;
      centres.sizes().maxCoeff(&axis);
      std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(half),
                       range.end(), [&](std::int32_t i, std::int32_t j) {
                         const double a = boxes[i].center()[axis], b = boxes[j].center()[axis];
                         return a < b || (a == b && i < j);
                       });
    }
    return {range.first(half), range.subspan(half)};
  }

  std::vector<Node> nodes_;
};

}  // namespace repel
