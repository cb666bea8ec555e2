// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The tangent planes of an ellipsoid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <repel/base/vec.hpp>
#include <repel/geometry/sphere_grid.hpp>

namespace repel {

/// Tangent half spaces n.x <= offset of an ellipsoid, n unit. They touch at the images of the nodes
/// of a SphereGrid under x -> a x, a the semi-axes. None is stored: the index of a plane is the
/// name of its node.
class OvalTangents {
 public:
  OvalTangents() = default;  ///< no planes
  /// @param semi_axes [m] each above 0
  explicit OvalTangents(const Vec3& semi_axes)
      : axes_(semi_axes),
        inverse_(semi_axes.cwiseInverse()),
        count_(SphereGrid::size),
        most_(semi_axes.maxCoeff()) {
    const double least = semi_axes.minCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      beyond_[static_cast<std::size_t>(axis)] =
          (semi_axes[axis] - least) * (semi_axes[axis] + least);
    }
  }

  /// [m] How far the planes lie outside the ellipsoid at most; and how much nearer another plane
  /// may be to a point than the one found by nearest().
  [[nodiscard]] double sagitta() const noexcept { return SphereGrid::sagitta * most_; }
  /// Number of planes.
  [[nodiscard]] std::uint32_t size() const noexcept { return count_; }
  /// Unit, outward; `i` less than size().
  [[nodiscard]] Vec<double> normal(std::uint32_t i) const noexcept {
    const Vec<double> n = product(inverse_, SphereGrid::node(i));
    return (1.0 / std::sqrt(dot(n, n))) * n;
  }
  /// [m]
  [[nodiscard]] double offset(std::uint32_t i) const noexcept {
    const Vec<double> u = SphereGrid::node(i);
    const Vec<double> n = product(inverse_, u);
    return std::sqrt(dot(u, u) / dot(n, n));
  }
  /// The plane that touches nearest to the ray from the centre to `x`.
  [[nodiscard]] std::uint32_t behind(const Vec<double>& x) const noexcept {
    return SphereGrid::nearest(product(inverse_, x));
  }

  /// The plane that touches nearest to the point of the surface nearest to `x` [m], inside or
  /// outside. Must not be empty. Cost: some divisions and square roots.
  ///
  /// Semi-axes a, the least of them c. The nearest point is a^2 x / (s + a^2 - c^2), part by part.
  /// The multiplier s > 0 puts it on the surface: u = a x / (s + a^2 - c^2) has length 1. As
  /// 1 / |u| is concave in s, Newton's method converges to s from below.
  [[nodiscard]] std::uint32_t nearest(const Vec<double>& x) const noexcept {
    // A point in a plane of symmetry is nearest to two points. It counts as being off that plane.
    const Vec3 point = to_vec3(x);
    const Vec3 axes = to_vec3(axes_);
    Vec3 pull;
    double s = 0.0;
    for (int k = 0; k < 3; ++k) {
      pull[k] = axes[k] * std::max(std::abs(point[k]), 1e-20 * most_);
      s = std::max(s, pull[k] - beyond_[static_cast<std::size_t>(k)]);
    }
    Vec3 u;
    for (int step = 0; step < most_steps; ++step) {
      double square = 0.0;
      double fall = 0.0;
      for (int k = 0; k < 3; ++k) {
        const double part = 1.0 / (s + beyond_[static_cast<std::size_t>(k)]);
        u[k] = pull[k] * part;
        square += u[k] * u[k];
        fall += u[k] * u[k] * part;
      }
      if (!(square > 1.0 + 1e-14)) break;
      s += (square * std::sqrt(square) - square) / fall;
    }
    for (int k = 0; k < 3; ++k) u[k] = std::copysign(u[k], point[k]);
    return SphereGrid::nearest(Vec<double>(u));
  }

 private:
  static constexpr int most_steps = 40;  ///< a few are usual

  Vec<double> axes_{};              ///< [m]
  Vec<double> inverse_{};           ///< [1/m]
  std::array<double, 3> beyond_{};  ///< [m^2] squares of the semi-axes, less that of the least
  std::uint32_t count_ = 0;
  double most_ = 0.0;  ///< [m] largest semi-axis
};

}  // namespace repel
