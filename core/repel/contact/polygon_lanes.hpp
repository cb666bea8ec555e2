// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vectors and polygons in the tangent planes of several contacts, one per SIMD lane.
#pragma once

#include <array>
#include <cstddef>

#include <repel/base/lanes.hpp>
#include <repel/contact/plane.hpp>

namespace repel::detail {

/// One Planar per lane.
struct PlanarLanes {
  Lanes x, y;

  friend PlanarLanes operator+(const PlanarLanes& a, const PlanarLanes& b) noexcept {
    return {a.x + b.x, a.y + b.y};
  }
  friend PlanarLanes operator-(const PlanarLanes& a, const PlanarLanes& b) noexcept {
    return {a.x - b.x, a.y - b.y};
  }
  friend PlanarLanes operator*(const Lanes& s, const PlanarLanes& a) noexcept {
    return {s * a.x, s * a.y};
  }
  friend Lanes dot(const PlanarLanes& a, const PlanarLanes& b) noexcept {
    return a.x * b.x + a.y * b.y;
  }
  friend Lanes cross(const PlanarLanes& a, const PlanarLanes& b) noexcept {
    return a.x * b.y - a.y * b.x;
  }
  friend PlanarLanes either(const LaneMask& first, const PlanarLanes& a,
                            const PlanarLanes& b) noexcept {
    return {either(first, a.x, b.x), either(first, a.y, b.y)};
  }
};

/// PlanarAxes, one per lane.
struct PlanarLaneAxes {
  LaneVec n, e1, e2;  ///< unit, world axes

  explicit PlanarLaneAxes(const LaneVec& normal) noexcept : n(normal) {
    const Lanes none{};
    const LaneVec side =
        either(magnitudes(n.z) < 0.7, LaneVec(-n.y, n.x, none), LaneVec(none, -n.z, n.y));
    e1 = (1.0 / roots(dot(side, side))) * side;
    e2 = cross(n, e1);
  }
  [[nodiscard]] PlanarLanes in_plane(const LaneVec& v) const noexcept {
    return {dot(e1, v), dot(e2, v)};
  }
  [[nodiscard]] LaneVec in_world(const PlanarLanes& v) const noexcept {
    return v.x * e1 + v.y * e2;
  }
};

/// Polygonal flat features, one per lane.
struct PolygonLanes {
  static constexpr std::size_t most = 8;

  std::array<PlanarLanes, most> corners;  ///< [m] counter-clockwise, the nearest point at r = 0
  std::size_t size = 4;                   ///< corners in every lane
  PlanarLanes slope{};
  LaneMask valid{};     ///< the lane has a polygon
  LaneMask is_large{};  ///< of more than four corners

  /// The faces of boxes.
  /// @param half [m] extents, X_W their poses, n outward in the frames of the boxes
  /// @param nearest [m] from their origins, world axes
  /// @param angle [rad] within which edges count as flat
  void set_boxes(const LaneVec& half, const LanePose& X_W, const LaneVec& n, const LaneVec& nearest,
                 const PlanarLaneAxes& axes, const Lanes& angle) noexcept {
    const Lanes none{};
    const LaneVec off = magnitudes(n);
    const LaneMask x = (off.x < angle) & (half.x > none);
    const LaneMask y = (off.y < angle) & (half.y > none);
    const LaneMask z = (off.z < angle) & (half.z > none);
    const auto& columns = X_W.columns;
    valid = ((x & y) | (x & z) | (y & z)) & ~(x & y & z);
    const LaneVec side = either(x & y, columns[2], either(x, columns[1], columns[0]));
    const Lanes height = either(x & y, half.z, either(x, half.y, half.x));
    const Lanes facing = either(x & y, n.z, either(x, n.y, n.x));
    const PlanarLanes centre =
        axes.in_plane(either(facing > none, height, -height) * side - nearest);
    // Lanes without one hold a square, so that nothing invalid is computed in them.
    const Lanes one = all_of(1.0);
    const PlanarLanes u =
        either(valid, either(x, half.x, half.y) * axes.in_plane(either(x, columns[0], columns[1])),
               {one, none});
    const PlanarLanes w =
        either(valid, either(z, half.z, half.y) * axes.in_plane(either(z, columns[2], columns[1])),
               {none, one});
    const PlanarLanes v = either(cross(u, w) < none, {-w.x, -w.y}, w);
    corners[0] = centre - u - v;
    corners[1] = centre + u - v;
    corners[2] = centre + u + v;
    corners[3] = centre - u + v;
    size = 4;
    slope = (-1.0 / either(valid, dot(side, axes.n), one)) * axes.in_plane(side);
  }

  /// Number of sides it is padded to, by splitting the last one.
  [[nodiscard]] static constexpr std::size_t sides_for(std::size_t corners) noexcept {
    return corners > 4 ? most : 4;
  }

  /// Divides the last sides, so that there are `most` in every lane.
  void extend() noexcept {
    const PlanarLanes step =
        all_of(1.0 / static_cast<double>(most - 3)) * (corners[0] - corners[3]);
    for (std::size_t i = 4; i < most; ++i) {
      const PlanarLanes r = corners[3] + all_of(static_cast<double>(i - 3)) * step;
      corners[i] = size < most ? either(is_large, corners[i], r) : corners[i];
    }
    size = most;
  }

  /// Sets lane k to a polygon; false for one of too many corners, and for less than a polygon.
  bool set(int k, const Flat& flat) noexcept {
    const Outline& outline = flat.outline;
    if (outline.size < 3 || outline.size > static_cast<int>(most)) return false;
    is_large[k] = outline.size > 4 ? -1 : 0;
    const int parts =
        static_cast<int>(sides_for(static_cast<std::size_t>(outline.size))) - outline.size + 1;
    const Planar last = outline.at(outline.size - 1).r;
    const Planar step = (1.0 / parts) * (outline.at(0).r - last);
    for (int i = 0; i < outline.size + parts - 1; ++i) {
      const Planar r =
          i < outline.size ? outline.at(i).r : last + (1.0 * (i - outline.size + 1)) * step;
      corners[static_cast<std::size_t>(i)].x[k] = r.x;
      corners[static_cast<std::size_t>(i)].y[k] = r.y;
    }
    slope.x[k] = flat.slope.x;
    slope.y[k] = flat.slope.y;
    valid[k] = -1;
    return true;
  }
};

}  // namespace repel::detail
