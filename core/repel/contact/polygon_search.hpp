// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The contact patches of several pairs of facing polygons at once.
#pragma once

#include <bit>
#include <cstddef>

#include <repel/contact/face_lanes.hpp>
#include <repel/contact/patch.hpp>
#include <repel/contact/polygon_mean.hpp>
#include <repel/distance/feature_lanes.hpp>

namespace repel::detail {

/// The members of ContactPatch, one pair per lane.
struct PolygonPatches {
  Lanes nearer{};             ///< [m]
  LaneVec force{}, torque{};  ///< [1], [m]
  LaneMask valid{};           ///< the others are to be found alone
};

/// `find_patch` for the lanes with polygons of few corners as features. The patch of a lane does
/// not depend on the others.
class PolygonSearch {
 public:
  /// @param tilt [rad] of the laws
  PolygonSearch(const FeatureLanes& features, const LaneGap& gap, const Lanes& tilt) noexcept
      : features_(features),
        gap_(gap),
        axes_(gap.n_BA_W),
        tilt_(either(tilt > Lanes{}, tilt, all_of(1.0))) {}

  /// Finds the features of those lanes.
  /// @param pose_a,pose_b called with k: the pose of the set in lane k
  /// @param faces_a,faces_b known faces of the sets; updated
  template <class PoseOfA, class PoseOfB>
  void find_flats(const LaneMask& lanes, const PoseOfA& pose_a, const PoseOfB& pose_b,
                  FaceLanes& faces_a, FaceLanes& faces_b) noexcept {
    const LaneVec p_AB = features_.B.X_W.columns[3] - features_.A.X_W.columns[3];
    find({features_.A, gap_.n_A, gap_.p_AQa_W, Facing::down}, lanes, pose_a, faces_a, a_);
    find({features_.B, gap_.n_B, gap_.p_AQb_W - p_AB, Facing::up}, lanes & a_.valid, pose_b,
         faces_b, b_);
  }
  /// Bit k: no patch, as one of the sets in lane k shows a corner.
  [[nodiscard]] unsigned corners() const noexcept { return corners_; }

  /// Of the lanes with so many sides, `PolygonLanes::most` or the 4 of boxes.
  template <std::size_t sides>
  [[nodiscard]] PolygonPatches patches(const LaneMask& lanes, const Lanes& depth_a) noexcept {
    PolygonPatches patches;
    const LaneMask is_large = a_.is_large | b_.is_large;
    const LaneMask fits = lanes & a_.valid & b_.valid & (sides > 4 ? is_large : ~is_large);
    if (bits_of(fits) == 0U) return patches;
    if (sides > 4) {
      a_.extend();
      b_.extend();
    }
    const PlanarLanes lean = b_.slope - a_.slope;
    const Lanes off = roots(larger(dot(a_.slope, a_.slope), dot(b_.slope, b_.slope)));
    const PolygonMean<sides> mean(a_, b_, lean, tilt_, off);
    const LaneVec& n = axes_.n;
    const LaneVec slanted = axes_.in_world(a_.slope);
    patches.force = n - (1.0 - mean.held()) * slanted + axes_.in_world(mean.pull());
    const LaneVec point = axes_.in_world(mean.point()) + dot(a_.slope, mean.point()) * n;
    patches.torque = cross(point, n - slanted) + mean.drill() * n +
                     cross(n, axes_.in_world(mean.lifted(a_.slope)) + depth_a * patches.force);
    const Lanes share = smaller(
        larger((roots(dot(lean, lean)) - 2.0 * tilt_) / (3.0 * tilt_), Lanes{}), all_of(1.0));
    patches.nearer = mean.nearer() - share * mean.farthest();
    patches.valid = fits & mean.is_sure();
    return patches;
  }

 private:
  /// One side of the pairs.
  struct Side {
    const LaneSets& sets;
    const LaneVec& n;       ///< outward, in the frames of the sets
    const LaneVec nearest;  ///< [m] from their origins, world axes
    Facing facing;
  };

  template <class PoseOf>
  void find(const Side& side, const LaneMask& lanes, const PoseOf& pose, FaceLanes& faces,
            PolygonLanes& polygons) noexcept {
    const LaneSets& sets = side.sets;
    polygons.set_boxes(sets.half_extents, sets.X_W, side.n, side.nearest, axes_,
                       TiltMean::faded * tilt_);
    const unsigned hulls = bits_of(lanes) & sets.hulls;
    if (hulls == 0U) return;
    LaneMask known = faces.holds(side.n, tilt_) & lanes;
    for (unsigned left = hulls & ~bits_of(known); left != 0U; left &= left - 1U) {
      find_flat(side, std::countr_zero(left), pose, faces, polygons);
    }
    // Whether a face was known does not show in the result.
    known = faces.holds(side.n, tilt_) & lanes;
    if (bits_of(known) != 0U) faces.place(known, sets.X_W, side.nearest, axes_, polygons);
  }

  template <class PoseOf>
  void find_flat(const Side& side, int k, const PoseOf& pose, FaceLanes& faces,
                 PolygonLanes& polygons) noexcept {
    const Convex& set = *side.sets.sets[static_cast<std::size_t>(k)];
    const PlanarAxes axes(Vec<double>(axes_.n.at(k)));
    const Flat flat =
        FlatSearch(set, pose(k), axes, side.facing, Vec<double>(side.nearest.at(k)), tilt_[k])
            .run();
    if (flat.outline.size < 2) corners_ |= 1U << k;
    if (!(flat.tilt > 0.0) || !polygons.set(k, flat)) return;
    tilt_[k] = flat.tilt;
    if (flat.face != Flat::no_face) faces.set(k, set, flat.face, side.facing);
  }

  const FeatureLanes& features_;
  const LaneGap& gap_;
  PlanarLaneAxes axes_;
  Lanes tilt_;  ///< [rad] up to which no other features are nearest
  PolygonLanes a_, b_;
  unsigned corners_ = 0;
};

}  // namespace repel::detail
