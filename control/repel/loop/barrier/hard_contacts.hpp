// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Possible points of entry into the hard walls of a world, on near pairs, with their gaps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/loop/barrier/active_contacts.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// A point at which two bodies of a hard pair may meet.
struct HardContact {
  PairId pair;           ///< whose wall is hard
  BodyId a;              ///< the moving body; the tool, for a held one
  BodyId b;              ///< likewise, of the other part
  Wrench on_a;           ///< [1, m] on A of a unit separating force, about the origin of its body
  Wrench on_b;           ///< on B, likewise
  double gap = 0.0;      ///< [m] there, along that force: at most the distance of the pair
  double rate = 0.0;     ///< [m/s] of the gap, positive on retreat
  double bending = 0.0;  ///< [m/s^2] of the rate as both bodies go on with constant twists
  bool is_between_arms = false;  ///< two arms can close the gap
  std::int32_t at = 0;           ///< which point of the pair it is
};

/// The contacts of all arms, for the tick of one.
struct Contacts {
  std::span<const ActiveContact> active;  ///< that exert a force
  std::span<const HardContact> hard{};    ///< that must not be entered
  std::int32_t left_out = 0;              ///< hard ones for which there was no room
};

/// Some pair of the world is hard.
[[nodiscard]] bool has_hard(const World& world) noexcept;

/// Collects the points of the near hard pairs, at the present poses. The answer of a pair may be
/// old. It gives a direction, along which the separation is a lower bound of the distance, and
/// where the shapes are nearest.
///
/// The nearest point is not enough: between nearly parallel faces, a small turn moves it to the
/// other end of the face. That end may approach while the first one retreats. So the plane is
/// tilted about a ring of directions by the turn expected soon, and the corner it touches is taken.
///
/// Allocates at construction only; points beyond its capacity are left out and counted.
class HardContacts {
 public:
  static constexpr int ring = 8;  ///< directions along the plane

  /// @param moved the bodies that arms move
  HardContacts(const World& world, std::span<const BodyId> moved);

  /// There are hard pairs.
  [[nodiscard]] bool any() const noexcept { return !contacts_.empty(); }

  /// Collects those of the last exchange. Cost: a look at each near pair; for a hard one that
  /// could be entered soon 18 evaluations of both support maps, about 1 us.
  /// @param reaction [s] until a torque acts: walls out of reach within reaction and braking, at
  /// present speed plus its possible gain, have no points
  void collect(const Coprocessor& coprocessor, double reaction) noexcept;

  /// The contacts of the last `collect`.
  [[nodiscard]] std::span<const HardContact> all() const noexcept;
  /// Points that found no room at the last `collect`.
  [[nodiscard]] int left_out() const noexcept { return left_out_; }

 private:
  static constexpr std::size_t most_pairs = 512;
  static constexpr double braking = 0.1;        // [s] from the speed of now to rest
  static constexpr double acceleration = 50.0;  // [m/s^2] of what begins to move
  static constexpr double least_tilt = 0.02;    // [rad]
  static constexpr double most_tilt = 0.3;      // [rad]
  static constexpr double same = 1e-4;          // [m] points as near as this are one

  /// One shape at its pose, and how far it reaches.
  struct Side {
    const Level& level;
    Pose X_W;
    /// [m] in the world: the farthest point along `d`, of the core, moved out by its depth along
    /// the unit `out`.
    [[nodiscard]] Vec3 farthest(const Vec3& d, const Vec3& out) const noexcept;
  };

  void add(const NearPair& near, const Pair& pair) noexcept;

  // Keeps the nearest point of a pair, and others where they may close soon.
  void push_back(HardContact contact, const Vec3& n, const Vec3& p_W, double gap) noexcept;

  // [m/s^2] The centripetal part, and the part of the turning normal.
  [[nodiscard]] static double bending_of(const Vec3& n, const Vec3& p_W, const BodyState& A,
                                         const BodyState& B) noexcept;

  /// [m/s] of a point of the body.
  [[nodiscard]] static Vec3 velocity(const BodyState& body, const Vec3& p_W) noexcept;
  [[nodiscard]] const BodyState& state(BodyId body) const noexcept;
  [[nodiscard]] bool is_moved(BodyId body) const noexcept;

  const World* world_;
  std::vector<std::uint8_t> is_moved_;                // by BodyId
  std::array<std::array<double, 2>, ring> around_{};  // unit vectors of the ring
  std::vector<HardContact> contacts_;
  std::size_t count_ = 0;
  int left_out_ = 0;
  double reaction_ = 0.0;  // [s]
  double near_ = 0.0;      // [m] gaps of this pair up to this may close suddenly
};

}  // namespace repel
