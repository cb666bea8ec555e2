/// @file
/// Vertices kept in three padded arrays, and the scan for the one farthest along a direction.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/vec.hpp>

namespace repel {

/// The vertices of a polytope, structure of arrays, padded with the first vertex to full lanes.
/// `scan` gives the same vertex whether the compiler has wide registers or not: the lanes only
/// change the order in which candidates are compared, and ties go to the lowest index.
class VertexScan {
 public:
  static constexpr int lanes = 4;

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
  // Each lane keeps its own best, so that no comparison waits for the one before it.
  double best[lanes];
  std::int64_t index[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    best[lane] = -std::numeric_limits<double>::infinity();
    index[lane] = 0;
  }
  const auto count = static_cast<std::int64_t>(x_.size());
  for (std::int64_t i = 0; i < count; i += lanes) {
    for (int lane = 0; lane < lanes; ++lane) {
      const auto k = static_cast<std::size_t>(i + lane);
      const double along = x_[k] * d.x + y_[k] * d.y + z_[k] * d.z;
      const bool farther = along > best[lane];
      best[lane] = farther ? along : best[lane];
      index[lane] = farther ? i + lane : index[lane];
    }
  }
  int winner = 0;
  for (int lane = 1; lane < lanes; ++lane) {
    const bool farther =
        best[lane] > best[winner] || (best[lane] == best[winner] && index[lane] < index[winner]);
    if (farther) winner = lane;
  }
  return index[winner] < size_ ? static_cast<std::uint32_t>(index[winner]) : 0U;
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
