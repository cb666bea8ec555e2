/// @file
/// Vertices kept in three padded arrays, and the scan for the one farthest along a direction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/vec.hpp>

namespace repel {

namespace detail {

// As many numbers as one register of the target holds. The arithmetic is the same for all widths,
// and so is the vertex found.
#if defined(__AVX512F__)
inline constexpr int lane_bytes = 64;
#elif defined(__AVX__)
inline constexpr int lane_bytes = 32;
#else
inline constexpr int lane_bytes = 16;
#endif
inline constexpr int lane_count = lane_bytes / 8;
using Lanes = double __attribute__((vector_size(lane_bytes)));

}  // namespace detail

/// The vertices of a polytope, structure of arrays, padded with the first vertex to full lanes.
/// `scan` gives the same vertex whether the compiler has wide registers or not: the lanes only
/// change the order in which candidates are compared, and ties go to the lowest index.
class VertexScan {
 public:
  static constexpr int lanes = 8;  ///< the arrays are padded to a multiple of this

  VertexScan() = default;
  explicit VertexScan(std::span<const Vec3> vertices)
      : size_(static_cast<int>(vertices.size())),
        stride_((vertices.size() + lanes - 1) / lanes * lanes),
        block_(3 * stride_),
        rows_(vertices.begin(), vertices.end()) {
    for (std::size_t i = 0; i < stride_; ++i) {
      const Vec3& v = vertices[i < vertices.size() ? i : 0];
      for (std::size_t axis = 0; axis < 3; ++axis) block_[axis * stride_ + i] = v[axis];
    }
  }

  [[nodiscard]] int size() const noexcept { return size_; }
  /// Vertex i [m]; any number gives some vertex.
  [[nodiscard]] Vec<double> vertex(std::uint32_t i) const noexcept {
    return rows_[i < static_cast<std::uint32_t>(size_) ? i : 0U];
  }

  /// Index of the vertex with the largest product with `d`, the lowest of several. Cost: one pass
  /// over the vertices.
  [[nodiscard]] std::uint32_t scan(const Vec<double>& d) const noexcept;
  /// The same, decided in extended precision.
  [[nodiscard]] std::uint32_t scan(const Vec<DoubleDouble>& d) const noexcept;
  /// The largest product itself. Cost: half of `scan`.
  [[nodiscard]] double largest_product(const Vec<double>& d) const noexcept;

 private:
  int size_ = 0;
  std::size_t stride_ = 0;         ///< from one coordinate's numbers to the next one's
  std::vector<double> block_;      ///< [m] all x, all y, all z
  std::vector<Vec<double>> rows_;  ///< [m] the same, vertex by vertex
};

inline std::uint32_t VertexScan::scan(const Vec<double>& d) const noexcept {
  // Each lane keeps its own best, so that no comparison waits for the one before it. Indices travel
  // as doubles: they share the registers and the masks of the products.
  using detail::Lanes;
  constexpr std::size_t width = detail::lane_count;
  constexpr std::size_t rows = lanes / width;
  static constexpr double first_indices[lanes] = {0, 1, 2, 3, 4, 5, 6, 7};
  Lanes best[rows];
  Lanes index[rows];
  Lanes here[rows];
  for (std::size_t row = 0; row < rows; ++row) {
    std::memcpy(&here[row], &first_indices[row * width], sizeof here[row]);
    best[row] = Lanes{} - std::numeric_limits<double>::infinity();
    index[row] = here[row];
  }
  const double* x_of = block_.data();
  const double* y_of = x_of + stride_;
  const double* z_of = y_of + stride_;
  for (std::size_t i = 0; i < stride_; i += lanes) {
    for (std::size_t row = 0; row < rows; ++row) {
      Lanes x, y, z;
      std::memcpy(&x, x_of + i + row * width, sizeof x);
      std::memcpy(&y, y_of + i + row * width, sizeof y);
      std::memcpy(&z, z_of + i + row * width, sizeof z);
      const Lanes along = x * d.x() + y * d.y() + z * d.z();
      const auto farther = along > best[row];
      best[row] = farther ? along : best[row];
      index[row] = farther ? here[row] : index[row];
      here[row] += lanes;
    }
  }
  double farthest = best[0][0];
  double winner = index[0][0];
  for (std::size_t k = 1; k < lanes; ++k) {
    const double along = best[k / width][k % width];
    const double i = index[k / width][k % width];
    const bool farther = along > farthest || (along == farthest && i < winner);
    farthest = farther ? along : farthest;
    winner = farther ? i : winner;
  }
  return winner < size_ ? static_cast<std::uint32_t>(winner) : 0U;
}

inline double VertexScan::largest_product(const Vec<double>& d) const noexcept {
  using detail::Lanes;
  constexpr std::size_t width = detail::lane_count;
  constexpr std::size_t rows = lanes / width;
  Lanes best[rows];
  for (Lanes& row : best) row = Lanes{} - std::numeric_limits<double>::infinity();
  const double* x_of = block_.data();
  const double* y_of = x_of + stride_;
  const double* z_of = y_of + stride_;
  for (std::size_t i = 0; i < stride_; i += lanes) {
    for (std::size_t row = 0; row < rows; ++row) {
      Lanes x, y, z;
      std::memcpy(&x, x_of + i + row * width, sizeof x);
      std::memcpy(&y, y_of + i + row * width, sizeof y);
      std::memcpy(&z, z_of + i + row * width, sizeof z);
      const Lanes along = x * d.x() + y * d.y() + z * d.z();
      best[row] = along > best[row] ? along : best[row];
    }
  }
  for (std::size_t row = 1; row < rows; ++row) {
    best[0] = best[row] > best[0] ? best[row] : best[0];
  }
  double largest = best[0][0];
  for (std::size_t k = 1; k < width; ++k) largest = std::max(largest, best[0][k]);
  return largest;
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
