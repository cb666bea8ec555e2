// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pairs within range whose nearest features are known, one per SIMD lane: their answers and forces
/// are computed together.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include <repel/contact/patch.hpp>
#include <repel/contact/pointed_pair.hpp>
#include <repel/contact/polygon_search.hpp>
#include <repel/distance/feature_lanes.hpp>
#include <repel/force/law_lanes.hpp>
#include <repel/pairs/lane_bodies.hpp>
#include <repel/pairs/pair_memory.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// As many pairs as there are lanes, their answers and forces at one tick. The result of a lane
/// depends only on its own pair.
class LaneGroup {
 public:
  /// Assigns lane k to a pair of polytopes, rounded or not, whose law is not passable.
  /// @param history with a known nearest feature of the level-0 shapes
  /// @param used false for a lane without a pair, which only needs valid data to compute with
  void set(const World& world, int k, const Pair& pair, const PairHistory& history,
           const PartPoses& poses, bool used) noexcept {
    used_[k] = used ? -1 : 0;
    of_a_.set(world, k, pair.a);
    of_b_.set(world, k, pair.b);
    features_.A.X_W.set(k, poses.last(pair.a));
    features_.B.X_W.set(k, poses.last(pair.b));
    law_.set(k, pair.law);
    tilt_[k] = pair.law.tilt;
    faces_a_.remove(k);
    faces_b_.remove(k);
    had_polygons_ &= ~(1U << k);
    depth_a_[k] = world.part(pair.a).shape.level(0).depth;
    depth_b_[k] = world.part(pair.b).shape.level(0).depth;
    nearest_[k] = std::numeric_limits<double>::infinity();
    peak_[k] = 0.0;
    deepest_[k] = 0.0;
    stale_ &= ~(1U << k);
    set_feature(world, k, pair, history);
  }

  /// Changes the features of the pair in lane k and discards its answer.
  void set_feature(const World& world, int k, const Pair& pair,
                   const PairHistory& history) noexcept {
    pointed_.set(k, history.pointed);
    features_.set(k, world.part(pair.a).shape.level(0).core, world.part(pair.b).shape.level(0).core,
                  history.warm);
    fixed_are_turned_ = false;
    discard_answer(k);
  }

  /// What is known of the pair in lane k.
  [[nodiscard]] PointedPair pointed(int k) const noexcept { return pointed_.at(k); }

  /// Computes the answers and forces of all lanes.
  [[gnu::noinline, gnu::flatten]] void evaluate(const Motion& motion, PartPoses& poses) noexcept {
    update_poses(of_a_, features_.A, motion);
    update_poses(of_b_, features_.B, motion);
    fixed_are_turned_ = true;
    const LaneGap gap = features_.prove({});
    apart_ = {gap, depth_a_, depth_b_, features_.A.X_W.columns[3]};
    const LaneMask proven = gap.proven & used_;
    const RelativeMotion<Lanes, LaneVec> relative = relative_motions(motion);
    p_AQ_W_ = apart_.p_WA - relative.p_WoA;
    gradient_W_ = apart_.extraction_W;
    moment_W_ = cross(p_AQ_W_, apart_.extraction_W);
    nearer_ = Lanes{};
    const PointedPairLanes::Shown shown = pointed_.shown(features_, gap);
    const LaneMask flat =
        proven & (apart_.lower < law_.range) & (tilt_ > Lanes{}) & shown.may_be_flat;
    if (bits_of(flat) != 0U) find_patches(flat, shown.edge, gap, motion, poses);
    compute_forces(relative, proven);
    tick_ = motion.tick;
    fresh_ = true;
    stale_ = 0;
  }

  /// Bit k: lane k has a pair.
  [[nodiscard]] unsigned used() const noexcept { return bits_of(used_); }
  /// Bit k: the lane is used and its feature was proven the nearest at the last evaluation, so that
  /// it has an answer.
  [[nodiscard]] unsigned proven() const noexcept { return proven_; }
  /// Bit k: the lane is proven and was within range.
  [[nodiscard]] unsigned in_range() const noexcept { return in_range_; }
  /// The answers are of this tick, provided that `begin_tick` is called at the start of each.
  [[nodiscard]] bool fresh() const noexcept { return fresh_; }
  void begin_tick() noexcept { fresh_ = false; }
  /// Bit k: a force was computed from the answer of lane k at a later tick.
  [[nodiscard]] unsigned stale() const noexcept { return stale_; }
  void set_stale(int k) noexcept { stale_ |= 1U << k; }
  /// Marks lane k as unused.
  void remove(int k) noexcept {
    used_[k] = 0;
    discard_answer(k);
  }
  void discard_answer(int k) noexcept {
    proven_ &= ~(1U << k);
    in_range_ &= ~(1U << k);
  }

  /// All pairs belong to the same two bodies, those of lane 0.
  [[nodiscard]] bool same_bodies() const noexcept { return of_a_.same_body() && of_b_.same_body(); }
  [[nodiscard]] BodyId body_a(int k) const noexcept { return of_a_.body(k); }
  [[nodiscard]] BodyId body_b(int k) const noexcept { return of_b_.body(k); }
  /// [N], [N m] on the bodies A, about the origin of each; zero for pairs out of range.
  [[nodiscard]] const LaneVec& force() const noexcept { return force_W_; }
  [[nodiscard]] const LaneVec& torque() const noexcept { return torque_W_; }
  /// [N] The magnitude of each force, and [m] the distances, infinite in lanes not proven.
  [[nodiscard]] const Lanes& sizes() const noexcept { return size_; }
  [[nodiscard]] const Lanes& distances() const noexcept { return distance_if_proven_; }
  [[nodiscard]] double distance(int k) const noexcept { return distance_if_proven_[k]; }
  [[nodiscard]] double force(int k) const noexcept { return size_[k]; }
  /// [m], [N] The least distance and the largest force of lane k since it was set.
  [[nodiscard]] double nearest(int k) const noexcept { return nearest_[k]; }
  [[nodiscard]] double peak(int k) const noexcept { return peak_[k]; }
  /// [m] Proven bounds of the penetration: of each lane at this tick, and of lane k since it was
  /// set. More than 0 for rounded shapes only, whose cores are apart while they overlap.
  [[nodiscard]] const Lanes& depths() const noexcept { return depth_; }
  [[nodiscard]] double deepest(int k) const noexcept { return deepest_[k]; }

  [[nodiscard]] PairAnswer answer(int k) const noexcept {
    PairAnswer answer;
    answer.last = separation_in(k);
    answer.nearer = nearer_[k];
    answer.gradient = {gradient_W_.at(k), moment_W_.at(k)};
    answer.p_AQ_W = p_AQ_W_.at(k);
    answer.p_BA_W = p_BA_W_.at(k);
    answer.turn = turn_[k];
    answer.tick = tick_;
    answer.waits_since = tick_;
    answer.in_range = (in_range_ >> k & 1U) != 0U;
    answer.force = size_[k];
    return answer;
  }

 private:
  [[nodiscard]] Separation separation_in(int k) const noexcept {
    return {apart_.distance[k],
            apart_.lower[k],
            apart_.upper[k],
            apart_.p_WA.at(k),
            apart_.p_WB.at(k),
            apart_.extraction_W.at(k),
            0,
            1,
            QueryEnd::converged};
  }

  void update_poses(const LaneBodies& bodies, LaneSets& sets, const Motion& motion) const noexcept {
    const bool are_fixed = bodies.are_fixed();
    if (!are_fixed) sets.X_W = bodies.poses(motion);
    if (!are_fixed || !fixed_are_turned_) sets.turn();
  }

  [[nodiscard]] RelativeMotion<Lanes, LaneVec> relative_motions(
      const Motion& motion) const noexcept {
    const auto one = [&](int k) {
      return relative_motion(of_a_.state(motion, k), of_b_.state(motion, k));
    };
    if (same_bodies()) return in_all_lanes(one(0));
    RelativeMotion<Lanes, LaneVec> each;
    for (int k = 0; k < lane_count; ++k) set_lane(each, k, one(k));
    return each;
  }

  /// The gradients of the patches of the pairs in `flat`.
  void find_patches(const LaneMask& may_be_flat, const LaneMask& may_be_edge, const LaneGap& gap,
                    const Motion& motion, PartPoses& poses) noexcept {
    LaneMask flat = may_be_flat;
    LaneMask edge = may_be_edge;
    const unsigned to_look_at = bits_of(flat) & ~had_polygons_;
    if (to_look_at != 0U) {
      pointed_.look_at(to_look_at, features_, gap, tilt_);
      const PointedPairLanes::Shown now = pointed_.shown(features_, gap);
      flat = flat & now.may_be_flat;
      edge = now.edge;
    }
    unsigned corners = 0;
    unsigned in_lanes = 0;
    // An edge is no polygon.
    const LaneMask polygons = flat & ~edge;
    if (bits_of(polygons) != 0U) {
      PolygonSearch search(features_, gap, tilt_);
      search.find_flats(
          polygons, [&](int k) -> const Pose& { return of_a_.posed(k, poses, motion).X_W; },
          [&](int k) -> const Pose& { return of_b_.posed(k, poses, motion).X_W; }, faces_a_,
          faces_b_);
      corners = search.corners();
      const auto take = [&](const PolygonPatches& found) {
        in_lanes |= bits_of(found.valid);
        nearer_ = either(found.valid, found.nearer, nearer_);
        gradient_W_ = either(found.valid, found.force, gradient_W_);
        moment_W_ = either(found.valid, found.torque + cross(p_AQ_W_, found.force), moment_W_);
      };
      take(search.patches<4>(polygons, depth_a_));
      take(search.patches<PolygonLanes::most>(polygons, depth_a_));
    }
    had_polygons_ = in_lanes;
    for (unsigned left = bits_of(flat) & ~(corners | in_lanes); left != 0U; left &= left - 1U) {
      find_patch_alone(std::countr_zero(left), motion, poses);
    }
  }

  void find_patch_alone(int k, const Motion& motion, PartPoses& poses) noexcept {
    ContactPatch patch;
    if (!find_patch(separation_in(k), of_a_.posed(k, poses, motion), of_b_.posed(k, poses, motion),
                    tilt_[k], patch)) {
      return;
    }
    const Vec3 force = patch.gradient.force;
    nearer_[k] = patch.nearer;
    gradient_W_.set(k, Vec<double>(force));
    moment_W_.set(k, Vec<double>(Vec3(patch.gradient.torque + p_AQ_W_.at(k).cross(force))));
  }

  void compute_forces(const RelativeMotion<Lanes, LaneVec>& relative,
                      const LaneMask& proven) noexcept {
    p_BA_W_ = relative.p_BA_W;
    turn_ = relative.turn;
    const Lanes distance = proven_distance(apart_.distance, apart_.lower) - nearer_;
    const LaneMask in_range = proven & (apart_.lower < law_.range);
    proven_ = bits_of(proven);
    in_range_ = bits_of(in_range);
    const Lanes none{};
    const LaneVec n = either(in_range, gradient_W_, LaneVec{});
    const LaneVec moment = either(in_range, moment_W_, LaneVec{});
    size_ = either(in_range, force_of<Lanes, LaneVec>(law_, distance, n, moment, relative), none);
    force_W_ = size_ * n;
    torque_W_ = size_ * moment;
    distance_if_proven_ =
        either(proven, apart_.distance, all_of(std::numeric_limits<double>::infinity()));
    depth_ = larger(either(proven, -apart_.lower, none), none);
    nearest_ = smaller(nearest_, distance_if_proven_);
    deepest_ = larger(deepest_, depth_);
    peak_ = larger(peak_, size_);
  }

  LaneBodies of_a_, of_b_;
  FeatureLanes features_;
  bool fixed_are_turned_ = false;  ///< corners of fixed parts are already rotated into world axes
  LawLanes law_;
  LaneMask used_{};
  Lanes depth_a_{}, depth_b_{};    ///< [m] rounding radius of the shapes
  Apart<Lanes, LaneVec> apart_{};  ///< of the last evaluation
  Lanes tilt_{};                   ///< [rad] of the laws
  PointedPairLanes pointed_;
  FaceLanes faces_a_, faces_b_;
  /// Bit k: the patch was that of two polygons at the last evaluation. It likely still is.
  unsigned had_polygons_ = 0;
  // The members of PairAnswer.
  LaneVec gradient_W_{}, moment_W_{};
  Lanes nearer_{};
  LaneVec p_AQ_W_{}, p_BA_W_{};
  Lanes turn_{};
  std::int64_t tick_ = PairAnswer::never;
  unsigned proven_ = 0;
  unsigned in_range_ = 0;
  unsigned stale_ = 0;
  bool fresh_ = false;
  Lanes size_{};                    ///< [N] magnitude of the force
  LaneVec force_W_{}, torque_W_{};  ///< [N], [N m] on A, about the origin of its body
  Lanes distance_if_proven_{};      ///< [m]
  Lanes depth_{};                   ///< [m] bound of the penetration; 0 where the pair is apart
  Lanes nearest_{}, peak_{}, deepest_{};
};

/// The extremes of several groups.
class GroupExtremes {
 public:
  void add(const LaneGroup& group) noexcept {
    sizes_ = larger(sizes_, group.sizes());
    distances_ = smaller(distances_, group.distances());
    depths_ = larger(depths_, group.depths());
  }
  /// [N] The largest force of one pair, [m] the least distance and the greatest depth.
  [[nodiscard]] double peak_force() const noexcept { return largest_of(sizes_); }
  [[nodiscard]] double nearest() const noexcept { return least_of(distances_); }
  [[nodiscard]] double deepest() const noexcept { return largest_of(depths_); }

 private:
  Lanes sizes_{};
  Lanes distances_ = all_of(std::numeric_limits<double>::infinity());
  Lanes depths_{};
};

}  // namespace repel::detail
