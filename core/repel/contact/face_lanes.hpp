// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Faces of polytopes, known from tick to tick, one per SIMD lane.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <repel/base/lanes.hpp>
#include <repel/contact/polygon_lanes.hpp>
#include <repel/contact/tilt_mean.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// Where a face of a polytope is alone.
struct AloneAround {
  /// [1] For unit vectors within this distance of its normal, the farthest vertex is one of its
  /// corners, and no face there is nearer.
  double within = 1.0;
  double room = 1.0;  ///< [rad] the least `Faces::room_of` of the faces sharing a vertex with it
};

/// Cost: a look at all faces sharing a vertex with it.
[[nodiscard]] inline AloneAround alone_around(const Faces& faces, std::uint32_t face) noexcept {
  constexpr double rounding = 1e-9;
  const Vec<double>& n = faces.normal(face);
  AloneAround alone;
  for (const std::uint32_t v : faces.corners(face)) {
    const auto around = faces.at(v);
    const auto edges = faces.edges_to(v);
    const auto own = std::find_if(around.begin(), around.end(),
                                  [&](const Faces::Corner& c) { return c.face == face; });
    for (std::size_t k = 0; k < around.size(); ++k) {
      alone.room = std::min(alone.room, faces.room_of(around[k].face));
      if (around[k].face == face) continue;
      const Vec<double> between = faces.normal(around[k].face) - n;
      alone.within = std::min(alone.within, 0.5 * std::sqrt(dot(between, between)));
      if (around[k].next != own->previous) alone.within = std::min(alone.within, dot(n, edges[k]));
    }
  }
  alone.within -= rounding;
  return alone;
}

/// One side of several pairs, one lane per pair: a face of its polytope, while it faces the other
/// set.
class FaceLanes {
 public:
  /// Forgets the face of lane k.
  void remove(int k) noexcept { within_[k] = -1.0; }
  /// Sets lane k to a face of at most `PolygonLanes::most` corners.
  void set(int k, const Convex& set, std::uint32_t face, Facing facing) noexcept {
    const Faces& faces = set.faces();
    const AloneAround alone = alone_around(faces, face);
    within_[k] = alone.within;
    room_[k] = alone.room;
    normal_.set(k, faces.normal(face));
    const auto names = faces.corners(face);
    const std::size_t last = names.size() - 1;
    const auto place = [&](std::size_t i) {
      return set.place(names[facing == Facing::up ? i : last - i]);
    };
    is_large_[k] = names.size() > 4 ? -1 : 0;
    const std::size_t all = PolygonLanes::sides_for(names.size());
    const Vec<double> step = (1.0 / static_cast<double>(all - last)) * (place(0) - place(last));
    for (std::size_t i = 0; i < all; ++i) {
      corners_[i].set(k, i <= last ? place(i) : place(last) + static_cast<double>(i - last) * step);
    }
  }
  /// True in lanes with that face as FlatSearch result for the unit vector n, at the whole tilt.
  [[nodiscard]] LaneMask holds(const LaneVec& n, const Lanes& tilt) const noexcept {
    const LaneVec off = n - normal_;
    const Lanes within = smaller(within_, TiltMean::faded * tilt);
    return (within > Lanes{}) & (room_ >= tilt) & (dot(off, off) < within * within);
  }
  /// Sets those lanes of `polygons` to the faces.
  /// @param nearest [m] the nearest points, from the origins of the sets, world axes
  void place(const LaneMask& lanes, const LanePose& X_W, const LaneVec& nearest,
             const PlanarLaneAxes& axes, PolygonLanes& polygons) const noexcept {
    const LaneVec normal = X_W.rotate(normal_);
    const Lanes upright = either(lanes, dot(normal, axes.n), all_of(1.0));
    polygons.slope = either(lanes, (-1.0 / upright) * axes.in_plane(normal), polygons.slope);
    polygons.valid = polygons.valid | lanes;
    polygons.is_large = polygons.is_large | (lanes & is_large_);
    const std::size_t size = bits_of(lanes & is_large_) != 0U ? PolygonLanes::most : 4;
    for (std::size_t i = 0; i < size; ++i) {
      const PlanarLanes r = axes.in_plane(X_W.rotate(corners_[i]) - nearest);
      polygons.corners[i] = either(lanes, r, polygons.corners[i]);
    }
  }

 private:
  LaneVec normal_{};             ///< in the frames of the sets
  Lanes within_ = all_of(-1.0);  ///< as AloneAround; negative: no face is known
  Lanes room_{};                 ///< [rad]
  LaneMask is_large_{};
  std::array<LaneVec, PolygonLanes::most> corners_{};  ///< [m] in the frames of the sets
};

}  // namespace repel::detail
