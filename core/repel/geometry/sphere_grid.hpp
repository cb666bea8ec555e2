// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Directions on a fine grid all around.
#pragma once

#include <cmath>
#include <cstdint>

#include <repel/base/vec.hpp>

namespace repel {

/// The nodes of square grids on the six faces of a cube, 1.6e9 of them. Each name below `size` is a
/// node. Those on an edge of the cube have two names, on a corner three. None is stored.
class SphereGrid {
 public:
  static constexpr std::uint32_t steps = 16382;     ///< along an edge; even: the axes are nodes
  static constexpr std::uint32_t side = steps + 1;  ///< nodes along an edge
  static constexpr std::uint32_t size = 6 * side * side;  ///< number of names
  /// 1 / cos a - 1, the surplus covers rounding: a [rad] is the largest angle to the nearest node.
  static constexpr double sagitta = 1.01 / (static_cast<double>(steps) * steps);

  /// A node, of length 1 to sqrt(3); any name gives one.
  [[nodiscard]] static Vec<double> node(std::uint32_t name) noexcept {
    const std::uint32_t face = name / (side * side) % 6;
    const double one = face % 2 == 0 ? 1.0 : -1.0;
    const double u = along(name / side % side);
    const double v = along(name % side);
    if (face < 2) return {one, u, v};
    if (face < 4) return {v, one, u};
    return {u, v, one};
  }

  /// The name of the node nearest to a direction, which need not be unit; of some node for 0 or
  /// NaN.
  [[nodiscard]] static std::uint32_t nearest(const Vec<double>& d) noexcept {
    const Vec<double> m = magnitudes(d);
    if (m.x() >= m.y() && m.x() >= m.z()) return name(0, d.x(), d.y(), d.z());
    if (m.y() >= m.z()) return name(2, d.y(), d.z(), d.x());
    return name(4, d.z(), d.x(), d.y());
  }

 private:
  [[nodiscard]] static double along(std::uint32_t step) noexcept {
    return 2.0 * step / steps - 1.0;
  }
  [[nodiscard]] static std::uint32_t step(double along) noexcept {
    const double nearest = std::floor(0.5 * steps * (along + 1.0) + 0.5);
    return nearest > 0.0 ? static_cast<std::uint32_t>(nearest) : 0U;  // NaN: 0
  }
  [[nodiscard]] static std::uint32_t name(std::uint32_t face, double most, double u,
                                          double v) noexcept {
    const double scale = 1.0 / std::abs(most);
    return ((face + (most < 0.0 ? 1U : 0U)) * side + step(scale * u)) * side + step(scale * v);
  }
};

}  // namespace repel
