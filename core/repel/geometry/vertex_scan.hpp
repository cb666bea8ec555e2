/// @file
/// Vertices kept in three padded arrays, and the scan for the one farthest along a direction.
#pragma once

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
  explicit VertexScan(std::span<const Vec3> vertices) : size_(static_cast<int>(vertices.size())) {
    const std::size_t padded = (vertices.size() + lanes - 1) / lanes * lanes;
    for (auto* axis : {&x_, &y_, &z_}) axis->reserve(padded);
    for (std::size_t i = 0; i < padded; ++i) {
      const Vec3& v = vertices[i < vertices.size() ? i : 0];
      x_.push_back(v.x());
      y_.push_back(v.y());
      z_.push_back(v.z());
    }
  }

  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] Vec3 vertex(std::uint32_t i) const noexcept { return {x_[i], y_[i], z_[i]}; }

  /// Index of the vertex with the largest product with `d`. Cost: one pass over the vertices.
  [[nodiscard]] std::uint32_t scan(const Vec<double>& d) const noexcept;
  /// The same, decided in extended precision.
  [[nodiscard]] std::uint32_t scan(const Vec<DoubleDouble>& d) const noexcept;

 private:
  [[nodiscard]] DoubleDouble exact_product(std::size_t i,
                                           const Vec<DoubleDouble>& d) const noexcept {
    return dot(Vec<DoubleDouble>(x_[i], y_[i], z_[i]), d);
  }

  int size_ = 0;
  std::vector<double> x_, y_, z_;  ///< [m]
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
  const std::size_t count = x_.size();
  for (std::size_t i = 0; i < count; i += lanes) {
    for (std::size_t row = 0; row < rows; ++row) {
      Lanes x, y, z;
      std::memcpy(&x, &x_[i + row * width], sizeof x);
      std::memcpy(&y, &y_[i + row * width], sizeof y);
      std::memcpy(&z, &z_[i + row * width], sizeof z);
      const Lanes along = x * d.x + y * d.y + z * d.z;
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

inline std::uint32_t VertexScan::scan(const Vec<DoubleDouble>& d) const noexcept {
  std::uint32_t winner = 0;
  DoubleDouble best = exact_product(0, d);
  for (std::uint32_t i = 1; i < static_cast<std::uint32_t>(size_); ++i) {
    const DoubleDouble along = exact_product(i, d);
    if (along > best) {
      best = along;
      winner = i;
    }
  }
  return winner;
}

}  // namespace repel
