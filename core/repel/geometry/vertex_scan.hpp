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
/// Bit k is set when number k of the four is `value`.
inline std::uint64_t which_equal(const double* four, double value) noexcept {
#ifdef __AVX__
  using Four = double __attribute__((vector_size(32)));
  Four numbers;
  std::memcpy(&numbers, four, sizeof numbers);
  return static_cast<std::uint64_t>(__builtin_ia32_movmskpd256((Four)(numbers == value)));
#else
  std::uint64_t bits = 0;
  for (unsigned k = 0; k < 4; ++k) bits |= std::uint64_t{four[k] == value} << k;
  return bits;
#endif
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
  double multiply(std::size_t begin, std::size_t end, const Vec<double>& d,
                  double* products) const noexcept;

  int size_ = 0;
  std::size_t stride_ = 0;         ///< from one coordinate's numbers to the next one's
  std::vector<double> block_;      ///< [m] all x, all y, all z
  std::vector<Vec<double>> rows_;  ///< [m] the same, vertex by vertex
};

inline std::uint32_t VertexScan::scan(const Vec<double>& d) const noexcept {
  // The largest product of a run first, then the lowest vertex that has it: no branch depends on
  // which one it is.
  constexpr std::size_t run = 64;
  double products[run];
  double farthest = -std::numeric_limits<double>::infinity();
  std::size_t winner = 0;
  for (std::size_t begin = 0; begin < stride_; begin += run) {
    const std::size_t end = std::min(begin + run, stride_);
    const double largest = multiply(begin, end, d, products);
    std::uint64_t has_it = 0;
    for (std::size_t i = begin; i < end; i += 4) {
      has_it |= detail::which_equal(products + (i - begin), largest) << (i - begin);
    }
    if (largest > farthest && has_it != 0) {
      farthest = largest;
      winner = begin + static_cast<std::size_t>(std::countr_zero(has_it));
    }
  }
  return static_cast<std::uint32_t>(winner);
}

/// The products of the vertices from `begin` to `end` with `d`, and the largest of them.
inline double VertexScan::multiply(std::size_t begin, std::size_t end, const Vec<double>& d,
                                   double* products) const noexcept {
  using detail::Lanes;
  constexpr std::size_t width = detail::lane_count;
  constexpr std::size_t rows = lanes / width;
  const double* x_of = block_.data();
  const double* y_of = x_of + stride_;
  const double* z_of = y_of + stride_;
  // Each row keeps its own best, so that no comparison waits for the one before it.
  Lanes best[rows];
  for (Lanes& row : best) row = Lanes{} - std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; i += lanes) {
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t at = i + row * width;
      Lanes x, y, z;
      std::memcpy(&x, x_of + at, sizeof x);
      std::memcpy(&y, y_of + at, sizeof y);
      std::memcpy(&z, z_of + at, sizeof z);
      const Lanes along = x * d.x() + y * d.y() + z * d.z();
      std::memcpy(products + (at - begin), &along, sizeof along);
      best[row] = detail::larger(along, best[row]);
    }
  }
  for (std::size_t row = 1; row < rows; ++row) best[0] = detail::larger(best[row], best[0]);
  return detail::largest_of(best[0]);
}

inline double VertexScan::largest_product(const Vec<double>& d) const noexcept {
  constexpr std::size_t run = 64;
  double products[run];
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t begin = 0; begin < stride_; begin += run) {
    largest = std::max(largest, multiply(begin, std::min(begin + run, stride_), d, products));
  }
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
