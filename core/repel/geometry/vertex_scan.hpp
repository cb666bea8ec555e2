/// @file
/// Vertices kept in three padded arrays, and the scan for the one farthest along a direction.
#pragma once

#include <algorithm>
#include <bit>
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

inline Lanes larger(const Lanes& a, const Lanes& b) noexcept {
  return a > b ? a : b;
}
inline double largest_of(const Lanes& x) noexcept {
  double largest = x[0];
  for (int k = 1; k < lane_count; ++k) largest = std::max(largest, x[k]);
  return largest;
}
inline double least_of(const Lanes& x) noexcept {
  double least = x[0];
  for (int k = 1; k < lane_count; ++k) least = std::min(least, x[k]);
  return least;
}

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
  /// The products of `d` with as many vertices as there are lanes, beginning with vertex i.
  [[nodiscard]] detail::Lanes products(std::size_t i, const Vec<double>& d) const noexcept {
    detail::Lanes x, y, z;
    std::memcpy(&x, block_.data() + i, sizeof x);
    std::memcpy(&y, block_.data() + stride_ + i, sizeof y);
    std::memcpy(&z, block_.data() + 2 * stride_ + i, sizeof z);
    return x * d.x() + y * d.y() + z * d.z();
  }

  int size_ = 0;
  std::size_t stride_ = 0;         ///< from one coordinate's numbers to the next one's
  std::vector<double> block_;      ///< [m] all x, all y, all z
  std::vector<Vec<double>> rows_;  ///< [m] the same, vertex by vertex
};

// Each lane keeps its own best and where it found it, in double as well, so that nothing branches on
// which vertex it is.
inline std::uint32_t VertexScan::scan(const Vec<double>& d) const noexcept {
  using detail::Lanes;
  constexpr double none = std::numeric_limits<double>::infinity();
  Lanes best = Lanes{} - none;
  Lanes winner{};
  Lanes here;
  for (int k = 0; k < detail::lane_count; ++k) here[k] = k;
  for (std::size_t i = 0; i < stride_; i += detail::lane_count) {
    const Lanes along = products(i, d);
    const auto farther = along > best;
    best = farther ? along : best;
    winner = farther ? here : winner;
    here += detail::lane_count;
  }
  const Lanes farthest = Lanes{} + detail::largest_of(best);
  return static_cast<std::uint32_t>(detail::least_of(best == farthest ? winner : Lanes{} + none));
}

inline double VertexScan::largest_product(const Vec<double>& d) const noexcept {
  using detail::Lanes;
  // Two rows, so that half of the comparisons need not wait for those before them.
  Lanes even = Lanes{} - std::numeric_limits<double>::infinity();
  Lanes odd = even;
  for (std::size_t i = 0; i < stride_; i += lanes) {
    for (std::size_t k = 0; k < lanes; k += 2 * detail::lane_count) {
      even = detail::larger(products(i + k, d), even);
      odd = detail::larger(products(i + k + detail::lane_count, d), odd);
    }
  }
  return detail::largest_of(detail::larger(odd, even));
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
