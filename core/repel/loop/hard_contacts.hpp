// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the hard walls of a world could be entered: the points of their near pairs that matter,
/// with their gaps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/loop/active_contacts.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// A point at which two bodies of a hard pair may meet.
struct HardContact {
  PairId pair;        ///< whose wall is hard
  BodyId a;           ///< the body that moves: a body that a tool holds is the tool
  BodyId b;           ///< likewise, of the other part
  Wrench on_a;        ///< [1, m] on A of a unit force that parts them, about the origin of its body
  Wrench on_b;        ///< on B, likewise
  double gap = 0.0;   ///< [m] there, along that force; of the pair, not larger than its distance
  double rate = 0.0;  ///< [m/s] of the gap, positive on retreat
  bool is_between_arms = false;  ///< two arms can close the gap
  std::int32_t at = 0;           ///< which point of the pair it is
};

/// What the tick of an arm needs to know of the contacts of all arms.
struct Contacts {
  std::span<const ActiveContact> active;  ///< that exert a force
  std::span<const HardContact> hard{};    ///< that must not be entered
};

/// Some pair of the world is hard.
[[nodiscard]] inline bool has_hard(const World& world) noexcept {
  return std::any_of(world.pairs().begin(), world.pairs().end(),
                     [](const Pair& pair) { return pair.law.hold == HoldKind::hard; });
}

/// Collects the points of the hard pairs that are near, at the present poses, whatever the age of
/// the answer of the pair: its direction alone is used, and the shapes are apart by at least what
/// they are apart along it.
///
/// The nearest point is not enough: where two faces are nearly parallel, a small turn moves it to
/// the other end of the face, which may approach as the first one retreats. So for a ring of
/// directions along the plane, the corner of what lies between both shapes is taken where the
/// plane, tilted by what the bodies turn soon, would touch.
///
/// Allocates at construction only; points beyond its capacity are left out and counted.
class HardContacts {
 public:
  static constexpr int ring = 8;  ///< directions along the plane

  /// @param moved the bodies that arms move
  HardContacts(const World& world, std::span<const BodyId> moved)
      : world_(&world), is_moved_(static_cast<std::size_t>(world.body_count()), 0) {
    for (const BodyId body : moved) is_moved_[static_cast<std::size_t>(body.index)] = 1;
    const auto is_hard = [](const Pair& pair) { return pair.law.hold == HoldKind::hard; };
    const auto hard = std::count_if(world.pairs().begin(), world.pairs().end(), is_hard);
    contacts_.resize(std::min<std::size_t>(static_cast<std::size_t>(hard), most_pairs) *
                     (1 + ring));
  }

  /// There are hard pairs.
  [[nodiscard]] bool any() const noexcept { return !contacts_.empty(); }

  /// Collects those of the last exchange. Cost: a look at each near pair; for a hard one that
  /// could be entered soon 18 evaluations of both support maps, about 1 us.
  /// @param soon [s] a pair that cannot be entered within this time has no points
  void collect(const Coprocessor& coprocessor, double soon) noexcept {
    count_ = 0;
    left_out_ = 0;
    soon_ = soon;
    if (!any()) return;
    coprocessor.for_each_near([&](const NearPair& near) {
      const Pair& pair = world_->pair(near.pair);
      if (pair.law.hold == HoldKind::hard) add(near.pair, pair, near.separation.extraction_W);
    });
    // What is made of them must not depend on how the pairs are shared out to threads.
    std::sort(contacts_.begin(), contacts_.begin() + static_cast<std::ptrdiff_t>(count_),
              [](const HardContact& x, const HardContact& y) {
                return x.pair.index != y.pair.index ? x.pair.index < y.pair.index : x.at < y.at;
              });
  }

  /// The contacts of the last `collect`.
  [[nodiscard]] std::span<const HardContact> all() const noexcept {
    return std::span(contacts_).first(count_);
  }
  /// Points that found no room at the last `collect`.
  [[nodiscard]] int left_out() const noexcept { return left_out_; }

 private:
  static constexpr std::size_t most_pairs = 512;
  static constexpr double least_tilt = 0.02;  // [rad]
  static constexpr double most_tilt = 0.3;    // [rad]

  /// One shape at its pose, and how far it reaches.
  struct Side {
    const Level& level;
    Pose X_W;
    /// [m] in the world: the farthest point along `d`, of the core, moved out by its depth along
    /// the unit `out`.
    [[nodiscard]] Vec3 farthest(const Vec3& d, const Vec3& out) const noexcept {
      const Vec<double> local = rotate_transposed(X_W, Vec<double>(d));
      return X_W * to_vec3(level.core.support(local).p) + level.depth * out;
    }
  };

  void add(PairId id, const Pair& pair, const Vec3& n) noexcept {
    const Motion& motion = world_->motion();
    const Part& part_a = world_->part(pair.a);
    const Part& part_b = world_->part(pair.b);
    const BodyState& A = state(part_a.body);
    const BodyState& B = state(part_b.body);
    HardContact contact;
    contact.pair = id;
    contact.a = carrier_of(motion, part_a.body);
    contact.b = carrier_of(motion, part_b.body);
    if (!is_moved(contact.a) && !is_moved(contact.b)) return;
    const BodyId arm_a = state(contact.a).arm;
    const BodyId arm_b = state(contact.b).arm;
    contact.is_between_arms = arm_a.valid() && arm_b.valid() && arm_a != arm_b;
    // What is still coming pushes by its law, in the time that it takes.
    if (share_between(A, B).now < 1.0 || !(dot(n, n) > 0.5)) return;
    const Side a{part_a.shape.level(0), composed(A.X_WB, part_a.X_BP)};
    const Side b{part_b.shape.level(0), composed(B.X_WB, part_b.X_BP)};
    const Vec3 p_WA = a.farthest(-n, -n);
    const Vec3 p_WB = b.farthest(n, n);
    const double gap = dot(n, p_WA - p_WB);
    const double turns = norm(A.V_WB.angular - B.V_WB.angular);
    const double extent = std::min(part_a.shape.reach(), part_b.shape.reach());
    const double fastest = norm(velocity(A, p_WA) - velocity(B, p_WA)) + 2.0 * turns * extent;
    if (gap > soon_ * fastest + pair.law.range) return;
    const double tilt = std::clamp(least_tilt + soon_ * turns, least_tilt, most_tilt);
    const Vec3 middle = 0.5 * (p_WA + p_WB);
    push_back(contact, n, middle, gap);
    const Vec3 t1 = across(n);
    const Vec3 t2 = n.cross(t1);
    for (int k = 0; k < ring; ++k) {
      const double angle = (k + 0.29) * 2.0 * std::numbers::pi / ring;
      const Vec3 t = std::cos(angle) * t1 + std::sin(angle) * t2;
      const Vec3 corner_a = a.farthest(tilt * t - n, -n);
      const Vec3 corner_b = b.farthest(tilt * t + n, n);
      const bool ends_with_a = dot(t, corner_a) <= dot(t, corner_b);
      const Vec3& at = ends_with_a ? corner_a : corner_b;
      const double there = ends_with_a ? dot(n, corner_a - p_WB) : dot(n, p_WA - corner_b);
      const Vec3 off = at - middle;
      if (norm(off - dot(off, n) * n) < 1e-4) continue;  // the nearest point again
      contact.at = k + 1;
      push_back(contact, n, at, there);
    }
  }

  void push_back(HardContact contact, const Vec3& n, const Vec3& p_W, double gap) noexcept {
    if (count_ == contacts_.size()) {
      ++left_out_;
      return;
    }
    const BodyState& A = state(contact.a);
    const BodyState& B = state(contact.b);
    contact.on_a = wrench_of_force(n, p_W - origin(A.X_WB));
    contact.on_b = wrench_of_force(-n, p_W - origin(B.X_WB));
    contact.gap = gap;
    contact.rate = power(contact.on_a, A.V_WB) + power(contact.on_b, B.V_WB);
    contacts_[count_++] = contact;
  }

  /// A unit vector perpendicular to the unit `n`.
  [[nodiscard]] static Vec3 across(const Vec3& n) noexcept {
    int least = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(n.coeff(axis)) < std::abs(n.coeff(least))) least = axis;
    }
    return direction_of(n.cross(unit(least)));
  }
  /// [m/s] of a point of the body.
  [[nodiscard]] static Vec3 velocity(const BodyState& body, const Vec3& p_W) noexcept {
    return body.V_WB.linear + body.V_WB.angular.cross(Vec3(p_W - origin(body.X_WB)));
  }
  [[nodiscard]] const BodyState& state(BodyId body) const noexcept {
    return world_->motion().bodies[static_cast<std::size_t>(body.index)];
  }
  [[nodiscard]] bool is_moved(BodyId body) const noexcept {
    return is_moved_[static_cast<std::size_t>(body.index)] != 0;
  }

  const World* world_;
  std::vector<std::uint8_t> is_moved_;  // by BodyId
  std::vector<HardContact> contacts_;
  std::size_t count_ = 0;
  int left_out_ = 0;
  double soon_ = 0.0;
};

}  // namespace repel
