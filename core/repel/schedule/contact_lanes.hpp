/// @file
/// Pairs within range whose nearest features are known: answered and turned into forces as many at
/// a time as a register of the target holds.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/distance/feature_lanes.hpp>
#include <repel/force/law_lanes.hpp>
#include <repel/schedule/pair_answer.hpp>
#include <repel/schedule/part_poses.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// One side of the pairs of a group: the parts and the bodies they belong to.
class LaneBodies {
 public:
  void set(const World& world, int k, PartId part) noexcept {
    parts_[index(k)] = part;
    bodies_[index(k)] = world.part(part).body;
    is_one_ = std::all_of(bodies_.begin(), bodies_.end(),
                          [&](BodyId body) { return body == bodies_[0]; });
  }
  /// All lanes have the same body: that of lane 0.
  [[nodiscard]] bool is_one() const noexcept { return is_one_; }
  [[nodiscard]] BodyId body(int k) const noexcept { return bodies_[index(k)]; }
  /// All lanes have the fixed body.
  [[nodiscard]] bool stand_still() const noexcept { return is_one_ && bodies_[0] == World::fixed; }
  [[nodiscard]] LanePose poses(PartPoses& of, const Motion& motion) const noexcept {
    std::array<const Pose*, lane_count> X_WP;
    for (std::size_t k = 0; k < X_WP.size(); ++k) X_WP[k] = &of.at(parts_[k], motion);
    return LanePose::of(X_WP);
  }
  [[nodiscard]] const BodyState& state(const Motion& motion, int k) const noexcept {
    return motion.bodies[bodies_[index(k)].index];
  }

 private:
  [[nodiscard]] static std::size_t index(int k) noexcept { return static_cast<std::size_t>(k); }

  std::array<PartId, lane_count> parts_{};
  std::array<BodyId, lane_count> bodies_{};
  bool is_one_ = false;  ///< all bodies are the same
};

/// As many pairs as there are lanes, and their answers and forces at one tick. Whatever a lane
/// holds depends on its own pair alone.
class ContactGroup {
 public:
  /// Gives lane k to a pair of polytopes, rounded or not, whose law is not passable.
  /// @param warm with a feature of the shapes themselves
  /// @param used false in a lane that is only to have some content
  void set(const World& world, int k, const Pair& pair, const WarmStart& warm,
           const PartPoses& poses, bool used) noexcept {
    used_[k] = used ? -1 : 0;
    of_a_.set(world, k, pair.a);
    of_b_.set(world, k, pair.b);
    features_.A.X_W.set(k, poses.last(pair.a));
    features_.B.X_W.set(k, poses.last(pair.b));
    law_.set(k, pair.law);
    depth_a_[k] = world.part(pair.a).shape.level(0).depth;
    depth_b_[k] = world.part(pair.b).shape.level(0).depth;
    nearest_[k] = std::numeric_limits<double>::infinity();
    peak_[k] = 0.0;
    stale_ &= ~(1U << k);
    renew(world, k, pair, warm);
  }

  /// The same pair with another feature.
  void renew(const World& world, int k, const Pair& pair, const WarmStart& warm) noexcept {
    features_.set(k, world.part(pair.a).shape.level(0).core, world.part(pair.b).shape.level(0).core,
                  warm);
    is_turned_ = false;
    forget(k);
  }

  /// Answers all lanes and works out their forces.
  [[gnu::noinline, gnu::flatten]] void evaluate(const Motion& motion, PartPoses& poses) noexcept {
    move(of_a_, features_.A, motion, poses);
    move(of_b_, features_.B, motion, poses);
    is_turned_ = true;
    const LaneGap gap = features_.prove(options);
    const LaneVec& n = gap.n_BA_W;
    const Lanes depth = depth_a_ + depth_b_;
    distance_ = gap.distance - depth;
    lower_ = outward(gap.lower - depth, -1.0);
    upper_ = outward(gap.upper - depth, 1.0);
    extraction_W_ = n;
    p_WA_ = features_.A.X_W.columns[3] + gap.p_AQa_W - depth_a_ * n;
    p_WB_ = features_.A.X_W.columns[3] + gap.p_AQb_W + depth_b_ * n;
    act(motion, gap.proven & used_);
    tick_ = motion.tick;
    fresh_ = true;
    stale_ = 0;
  }

  /// Bit k: lane k has a pair.
  [[nodiscard]] unsigned used() const noexcept { return bits_of(used_); }
  /// Bit k: and its answer holds at the tick of the last evaluation.
  [[nodiscard]] unsigned proven() const noexcept { return proven_; }
  /// Bit k: and it was within range.
  [[nodiscard]] unsigned inside() const noexcept { return inside_; }
  /// The answers are of this tick, if `grow_old` is called at the beginning of each.
  [[nodiscard]] bool fresh() const noexcept { return fresh_; }
  void grow_old() noexcept { fresh_ = false; }
  /// Bit k: a force was made of the answer of lane k at a later tick.
  [[nodiscard]] unsigned stale() const noexcept { return stale_; }
  void set_stale(int k) noexcept { stale_ |= 1U << k; }
  /// Lane k has no pair.
  void leave(int k) noexcept {
    used_[k] = 0;
    forget(k);
  }
  /// The answer of lane k no longer counts.
  void forget(int k) noexcept {
    proven_ &= ~(1U << k);
    inside_ &= ~(1U << k);
  }

  /// All pairs are of the same two bodies, as those of lane 0.
  [[nodiscard]] bool is_one_meeting() const noexcept { return of_a_.is_one() && of_b_.is_one(); }
  [[nodiscard]] BodyId body_a(int k) const noexcept { return of_a_.body(k); }
  [[nodiscard]] BodyId body_b(int k) const noexcept { return of_b_.body(k); }
  /// [N], [N m] What the pairs that are inside do to their bodies A, about the origin of each.
  [[nodiscard]] const LaneVec& force() const noexcept { return force_W_; }
  [[nodiscard]] const LaneVec& torque() const noexcept { return torque_W_; }
  /// [N] The size of each force, and [m] the distances, infinite where nothing was proven.
  [[nodiscard]] const Lanes& sizes() const noexcept { return size_; }
  [[nodiscard]] const Lanes& distances() const noexcept { return seen_distance_; }
  [[nodiscard]] double distance(int k) const noexcept { return seen_distance_[k]; }
  [[nodiscard]] double force(int k) const noexcept { return size_[k]; }
  /// [m], [N] The extremes of lane k since it was set.
  [[nodiscard]] double nearest(int k) const noexcept { return nearest_[k]; }
  [[nodiscard]] double peak(int k) const noexcept { return peak_[k]; }

  [[nodiscard]] PairAnswer answer(int k) const noexcept {
    PairAnswer answer;
    answer.last = {distance_[k],        lower_[k], upper_[k], p_WA_.at(k),        p_WB_.at(k),
                   extraction_W_.at(k), 0,         1,         QueryEnd::converged};
    answer.p_AQ_W = p_AQ_W_.at(k);
    answer.p_BA_W = p_BA_W_.at(k);
    answer.turn = turn_[k];
    answer.tick = tick_;
    answer.waits_since = tick_;
    answer.inside = (inside_ >> k & 1U) != 0U;
    answer.force = size_[k];
    return answer;
  }

 private:
  static constexpr QueryOptions options{};

  void move(const LaneBodies& bodies, LaneSets& sets, const Motion& motion,
            PartPoses& poses) const noexcept {
    const bool stand_still = bodies.stand_still();
    if (!stand_still) sets.X_W = bodies.poses(poses, motion);
    if (!stand_still || !is_turned_) sets.turn();
  }
  [[nodiscard]] static Lanes outward(const Lanes& bound, double side) noexcept {
    return bound + (side * 0x1p-51) * magnitudes(bound);
  }
  /// Where the bodies A are against the bodies B, and how they move.
  struct Relative {
    LaneVec p_WoA, p_BA_W;  ///< [m] origin of A; and from that of B
    LaneVec v_BA, w_BA;     ///< [m/s, rad/s] of A against B at the origin of A, world axes
    Lanes turn;             ///< [m] both bodies' BodyState::turn
  };
  [[nodiscard]] Relative relative(const Motion& motion) const noexcept {
    if (is_one_meeting()) {
      const RelativeOfOne one(of_a_.state(motion, 0), of_b_.state(motion, 0));
      return {LaneVec::all(one.p_WoA), LaneVec::all(one.p_BA_W), LaneVec::all(one.v_BA),
              LaneVec::all(one.w_BA), all_of(one.turn)};
    }
    Relative each;
    for (int k = 0; k < lane_count; ++k) {
      const RelativeOfOne one(of_a_.state(motion, k), of_b_.state(motion, k));
      each.p_WoA.set(k, one.p_WoA);
      each.p_BA_W.set(k, one.p_BA_W);
      each.v_BA.set(k, one.v_BA);
      each.w_BA.set(k, one.w_BA);
      each.turn[k] = one.turn;
    }
    return each;
  }
  struct RelativeOfOne {
    RelativeOfOne(const BodyState& A, const BodyState& B) noexcept
        : p_WoA(column<double>(A.X_WB, 3)),
          p_BA_W(p_WoA - column<double>(B.X_WB, 3)),
          v_BA(Vec<double>(A.V_WB.linear) - Vec<double>(B.V_WB.linear) -
               cross(Vec<double>(B.V_WB.angular), p_BA_W)),
          w_BA(Vec<double>(A.V_WB.angular) - Vec<double>(B.V_WB.angular)),
          turn(A.turn + B.turn) {}
    Vec<double> p_WoA, p_BA_W, v_BA, w_BA;
    double turn;
  };

  void act(const Motion& motion, const LaneMask& proven) noexcept {
    const Relative relative_now = relative(motion);
    p_AQ_W_ = p_WA_ - relative_now.p_WoA;
    p_BA_W_ = relative_now.p_BA_W;
    turn_ = relative_now.turn;
    // `PairAnswer::proven`.
    const Lanes safe = lower_ > 0.0 ? lower_ : distance_;
    const LaneMask inside = proven & (safe < law_.range);
    proven_ = bits_of(proven);
    inside_ = bits_of(inside);
    const Lanes none{};
    // n.(v + w x p) = n.v + w.(p x n), and p x n makes the torque as well.
    const LaneVec n = either(inside, extraction_W_, LaneVec{});
    const LaneVec arm = either(inside, cross(p_AQ_W_, extraction_W_), LaneVec{});
    const Lanes rate = dot(n, relative_now.v_BA) + dot(relative_now.w_BA, arm);
    size_ = inside ? law_(safe, rate) : none;
    force_W_ = size_ * n;
    torque_W_ = size_ * arm;
    seen_distance_ = proven ? distance_ : all_of(std::numeric_limits<double>::infinity());
    nearest_ = smaller(nearest_, seen_distance_);
    peak_ = larger(peak_, size_);
  }

  LaneBodies of_a_, of_b_;
  FeatureLanes features_;
  bool is_turned_ = false;  ///< the sets that stand still
  LawLanes law_;
  LaneMask used_{};
  Lanes depth_a_{}, depth_b_{};  ///< [m] by which the shapes are round
  // The members of Separation and PairAnswer.
  Lanes distance_{}, lower_{}, upper_{}, turn_{};
  LaneVec p_WA_{}, p_WB_{}, extraction_W_{}, p_AQ_W_{}, p_BA_W_{};
  std::int64_t tick_ = PairAnswer::never;
  unsigned proven_ = 0;
  unsigned inside_ = 0;
  unsigned stale_ = 0;
  bool fresh_ = false;
  Lanes size_{};                    ///< [N] of the force
  LaneVec force_W_{}, torque_W_{};  ///< [N], [N m] on A, about the origin of its body
  Lanes seen_distance_{};
  Lanes nearest_{}, peak_{};
};

/// The extremes of several groups.
class GroupExtremes {
 public:
  void add(const ContactGroup& group) noexcept {
    sizes_ = larger(sizes_, group.sizes());
    distances_ = smaller(distances_, group.distances());
  }
  /// [N] The largest force of one pair, and [m] the least distance.
  [[nodiscard]] double peak_force() const noexcept { return largest_of(sizes_); }
  [[nodiscard]] double nearest() const noexcept { return least_of(distances_); }

 private:
  Lanes sizes_{};
  Lanes distances_ = all_of(std::numeric_limits<double>::infinity());
};

}  // namespace repel::detail
