// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vertices stored in three padded arrays, and the scan for the one farthest along a direction.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/lanes.hpp>
#include <repel/base/vec.hpp>

namespace repel {

/// A view of vertices as three arrays, one after the other: all x, all y, all z, each `stride`
/// numbers long. `farthest` gives the same vertex at any register width: the lanes only change the
/// order in which candidates are compared, and ties go to the lowest index.
struct VertexBlock {
  static constexpr std::size_t lanes = 8;  ///< `stride` is a multiple of this

  const double* numbers = nullptr;  ///< [m]
  std::size_t stride = 0;           ///< from one coordinate to the next, in numbers

  /// Vertex i [m]; i must be valid.
  [[nodiscard]] Vec<double> vertex(std::uint32_t i) const noexcept {
    return {numbers[i], numbers[stride + i], numbers[2 * stride + i]};
  }
  /// Index of the vertex with the largest dot product with `d`, the lowest of several. Cost: one
  /// pass.
  [[nodiscard]] std::uint32_t farthest(const Vec<double>& d) const noexcept;
  /// The largest dot product itself. Cost: half of `farthest`.
  [[nodiscard]] double largest_product(const Vec<double>& d) const noexcept;
  /// The same for each of several directions. Cost: one pass for all.
  [[nodiscard]] detail::Lanes largest_products(const detail::LaneVec& d) const noexcept;
  /// The vertices rotated by `X`, written to `room`, an array of 3 x stride numbers.
  VertexBlock turned(const Pose& X, double* room) const noexcept;

 private:
  /// Coordinate `axis` of one register of vertices, starting with vertex i.
  [[nodiscard]] detail::Lanes coordinates(std::size_t axis, std::size_t i) const noexcept {
    detail::Lanes some;
    std::memcpy(&some, numbers + axis * stride + i, sizeof some);
    return some;
  }
  [[nodiscard]] detail::Lanes products(std::size_t i, double x, double y, double z) const noexcept {
    return coordinates(0, i) * x + coordinates(1, i) * y + coordinates(2, i) * z;
  }
};

/// The vertices of a polytope as a block, padded with the first vertex to full lanes, and a second
/// copy as one vector per vertex.
class VertexScan {
 public:
  VertexScan() = default;
  /// Copies the vertices [m] in the order of lanes. Allocates.
  explicit VertexScan(std::span<const Vec3> vertices)
      : size_(static_cast<int>(vertices.size())),
        stride_(stride_of(vertices.size())),
        numbers_(3 * stride_),
        rows_(vertices.begin(), vertices.end()) {
    for (std::size_t i = 0; i < stride_; ++i) {
      const Vec3& v = vertices[i < vertices.size() ? i : 0];
      for (std::size_t axis = 0; axis < 3; ++axis) numbers_[axis * stride_ + i] = v[axis];
    }
  }

  [[nodiscard]] int size() const noexcept { return size_; }  ///< number of vertices
  /// [byte] Heap memory held, and the heap memory of so many vertices.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return numbers_.capacity() * sizeof(double) + rows_.capacity() * sizeof(Vec<double>);
  }
  /// [bytes] Of heap for so many vertices.
  [[nodiscard]] static std::size_t bytes_of(std::size_t vertices) noexcept {
    return 3 * stride_of(vertices) * sizeof(double) + vertices * sizeof(Vec<double>);
  }
  /// The copy, valid as long as this object.
  [[nodiscard]] VertexBlock block() const noexcept { return {numbers_.data(), stride_}; }
  /// Vertex i [m]; an invalid index gives vertex 0.
  [[nodiscard]] Vec<double> vertex(std::uint32_t i) const noexcept {
    return rows_[i < static_cast<std::uint32_t>(size_) ? i : 0U];
  }

  /// Index of the vertex with the largest dot product with `d`, the lowest of several. Cost: one
  /// pass over the vertices.
  [[nodiscard]] std::uint32_t scan(const Vec<double>& d) const noexcept {
    return block().farthest(d);
  }
  /// The same, decided in extended precision.
  [[nodiscard]] std::uint32_t scan(const Vec<DoubleDouble>& d) const noexcept;

 private:
  [[nodiscard]] static std::size_t stride_of(std::size_t vertices) noexcept {
    return (vertices + VertexBlock::lanes - 1) / VertexBlock::lanes * VertexBlock::lanes;
  }

  int size_ = 0;
  std::size_t stride_ = 0;
  std::vector<double> numbers_;    ///< [m]
  std::vector<Vec<double>> rows_;  ///< [m]
};

// The largest product first, then the vertices with it: no vertex waits for a comparison with the
// one before.
inline std::uint32_t VertexBlock::farthest(const Vec<double>& d) const noexcept {
  using detail::lane_count;
  using detail::Lanes;
  constexpr std::size_t at_once = 32;
  double most = -std::numeric_limits<double>::infinity();
  std::size_t winner = 0;
  for (std::size_t first = 0; first < stride; first += at_once) {
    const std::size_t count = std::min(stride - first, at_once);
    std::array<Lanes, at_once / lane_count> along;
    Lanes best = detail::all_of(most);
    // Unrolled, the end of a short block has its own branch, which is soon predicted correctly.
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; i += lanes) {
      for (std::size_t k = i; k < i + lanes; k += lane_count) {
        along[k / lane_count] = products(first + k, d.x(), d.y(), d.z());
        best = detail::larger(along[k / lane_count], best);
      }
    }
    const double farthest = detail::largest_of(best);
    if (!(farthest > most)) continue;
    most = farthest;
    std::uint32_t found = 0;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; i += lanes) {
      for (std::size_t k = i; k < i + lanes; k += lane_count) {
        found |= detail::bits_of(along[k / lane_count] == detail::all_of(farthest)) << k;
      }
    }
    winner = first + static_cast<std::size_t>(std::countr_zero(found));
  }
  return static_cast<std::uint32_t>(winner);
}

inline double VertexBlock::largest_product(const Vec<double>& d) const noexcept {
  using detail::Lanes;
  Lanes largest = Lanes{} - std::numeric_limits<double>::infinity();
#pragma GCC unroll 4
  for (std::size_t i = 0; i < stride; i += lanes) {
    for (std::size_t k = 0; k < lanes; k += detail::lane_count) {
      largest = detail::larger(products(i + k, d.x(), d.y(), d.z()), largest);
    }
  }
  return detail::largest_of(largest);
}

inline detail::Lanes VertexBlock::largest_products(const detail::LaneVec& d) const noexcept {
  detail::Lanes largest = detail::Lanes{} - std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < stride; ++i) {
    largest = detail::larger(
        d.x * numbers[i] + d.y * numbers[stride + i] + d.z * numbers[2 * stride + i], largest);
  }
  return largest;
}

inline VertexBlock VertexBlock::turned(const Pose& X, double* room) const noexcept {
  for (std::size_t i = 0; i < stride; i += detail::lane_count) {
    for (int row = 0; row < 3; ++row) {
      const detail::Lanes sum = products(i, X(row, 0), X(row, 1), X(row, 2));
      std::memcpy(room + static_cast<std::size_t>(row) * stride + i, &sum, sizeof sum);
    }
  }
  return {room, stride};
}

inline std::uint32_t VertexScan::scan(const Vec<DoubleDouble>& d) const noexcept {
  const auto product = [&](std::uint32_t i) { return dot(Vec<DoubleDouble>(vertex(i)), d); };
  std::uint32_t winner = 0;
  DoubleDouble best = product(0);
  for (std::uint32_t i = 1; i < static_cast<std::uint32_t>(size_); ++i) {
    const DoubleDouble along = product(i);
    if (along > best) {
      best = along;
      winner = i;
    }
  }
  return winner;
}

}  // namespace repel
