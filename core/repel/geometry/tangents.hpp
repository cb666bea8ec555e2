// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The tangent planes of the curved side of a cylinder or a cone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <repel/base/vec.hpp>

namespace repel {

/// Half spaces n.x <= offset, n unit, all around the z axis: a prism or a pyramid with so many
/// sides that it deviates from the curved surface only by `sagitta`. None is stored: the index of a
/// plane encodes its direction.
class Tangents {
 public:
  Tangents() = default;  ///< no planes
  /// @param radial,axial components of every normal, together of length 1
  /// @param offset [m]
  Tangents(double radial, double axial, double offset)
      : radial_(radial), axial_(axial), offset_(offset), count_(4 * steps) {}

  /// [m] How far the edges of the prism around a circle of `radius` [m] protrude from the circle.
  [[nodiscard]] static constexpr double sagitta(double radius) noexcept {
    // Neighbouring normals differ by at most 2 / steps; the surplus covers terms of higher order.
    return 0.501 / (static_cast<double>(steps) * steps) * radius;
  }

  /// Number of tangent planes.
  [[nodiscard]] std::uint32_t size() const noexcept { return count_; }
  /// [m] of each plane from the centre.
  [[nodiscard]] double offset() const noexcept { return offset_; }

  /// Unit, outward; `i` less than size().
  [[nodiscard]] Vec<double> normal(std::uint32_t i) const noexcept {
    const double along = 2.0 * (i % steps) / steps - 1.0;
    const double scale = (i < 2 * steps ? radial_ : -radial_) / std::sqrt(1.0 + along * along);
    if (i / steps % 2 == 0) return {scale, along * scale, axial_};
    return {-along * scale, scale, axial_};
  }

  /// The plane below which `x` has the least depth; any plane when `x` is on the axis. Must not be
  /// empty.
  [[nodiscard]] std::uint32_t nearest(const Vec<double>& x) const noexcept {
    return at(std::floor(place(x) + 0.5));
  }
  /// The two planes on either side of the direction of `x` from the axis. Must not be empty.
  [[nodiscard]] std::array<std::uint32_t, 2> around(const Vec<double>& x) const noexcept {
    const double below = std::floor(place(x));
    return {at(below), at(below + 1.0)};
  }

 private:
  // In each quadrant the normals point at equal steps along the side of a square: finding the index
  // of a direction takes a division, finding the direction of an index a square root, and both are
  // exact on the axes. Fewer steps would show in the depth, more take longer to choose from.
  static constexpr std::uint32_t steps = 1U << 16U;

  /// Position around the axis, increasing, 0 to 4 `steps`; NaN on the axis.
  [[nodiscard]] static double place(const Vec<double>& x) noexcept {
    const bool ahead = std::abs(x.x()) >= std::abs(x.y());
    const double along = ahead ? x.y() / x.x() : -x.x() / x.y();
    const int quarter = ((ahead ? x.x() : x.y()) < 0.0 ? 2 : 0) + (ahead ? 0 : 1);
    return steps * (quarter + 0.5 * (along + 1.0));
  }
  [[nodiscard]] static std::uint32_t at(double place) noexcept {
    return static_cast<std::uint32_t>(std::max(0.0, place)) % (4 * steps);
  }

  double radial_ = 0.0;
  double axial_ = 0.0;
  double offset_ = 0.0;
  std::uint32_t count_ = 0;
};

}  // namespace repel
