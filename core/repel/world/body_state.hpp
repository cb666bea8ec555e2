// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The state of the bodies of a world at one instant, and how much of a force acts between two.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>
#include <repel/base/vec.hpp>

namespace repel {

/// A number that changes from tick to tick.
struct Ramp {
  double now = 0.0;     ///< at this tick
  double before = 0.0;  ///< at the last tick
  double rate = 0.0;    ///< [1/s] at which it goes on
};

/// How far a body that can come and go is there, and held by an arm.
struct Presence {
  Ramp there{};  ///< 0: absent; 1: all of its forces act
  /// -1: it lies free, and is an obstacle to every arm. +1: `holder` holds it, as part of its tool.
  /// Between: the change, in which first one kind of force goes and then the other comes.
  Ramp grip{-1.0, -1.0, 0.0};
  BodyId holder{};              ///< the tool that holds it or is about to
  std::int32_t generation = 0;  ///< how often it has come

  /// Some force on it acts or has acted at the last tick.
  [[nodiscard]] bool is_there() const noexcept { return there.now > 0.0 || there.before > 0.0; }
};

/// Pose, twist and accumulated travel of a body.
struct BodyState {
  Pose X_WB = Pose::Identity();  ///< [m]
  Twist V_WB;                    ///< [m/s, rad/s] of the body's origin, world axes
  double travel = 0.0;       ///< [m] upper bound on the path of any point of the body since set-up
  double turn = 0.0;         ///< [m] the part of `travel` due to rotation
  BodyId arm{};              ///< tool of the arm that the body belongs to; invalid: of none
  double reach = 0.0;        ///< [m] of its farthest point from its origin
  bool spares_held = false;  ///< a body of an arm that what its tool holds may touch
  bool is_loose = false;     ///< it can come and go: `presence` counts
  Presence presence{};       ///< of a loose body; others are always there
};

/// [m] Bodies are within this of the origin of the world, so that their distances can be told.
inline constexpr double farthest_place = 1e14;

/// True for a pose that is finite, rigid within `tolerance` per entry, and not too far.
[[nodiscard]] inline bool is_a_place(const Pose& X_WB, double tolerance) noexcept {
  return is_finite(X_WB) && is_rigid(X_WB, tolerance) && norm(origin(X_WB)) <= farthest_place;
}

/// Moves a body. False, with nothing changed, when the pose is no place or the twist not finite.
inline bool place(BodyState& body, const Pose& X_WB, const Twist& V_WB) noexcept {
  if (!is_a_place(X_WB, 1e-6) || !is_finite(V_WB)) return false;
  const auto moved = [&](int k) {
    const Vec<double> d = column<double>(X_WB, k) - column<double>(body.X_WB, k);
    return dot(d, d);
  };
  // |R - R'| (Frobenius) is 2 sqrt(2) sin(angle / 2), without the cancellation of an arc cosine.
  const double chord = std::sqrt(0.5 * (moved(0) + moved(1) + moved(2)));
  const double turned = body.reach * chord;
  const double rounding = 1e-14 * (norm(origin(X_WB)) + body.reach);
  body.travel += std::sqrt(moved(3)) + turned + rounding;
  body.turn += turned + rounding;
  body.X_WB = X_WB;
  body.V_WB = V_WB;
  return true;
}

/// All bodies at one instant: the input of the coprocessor.
struct Motion {
  std::int64_t tick = -1;         ///< -1: before the first one
  std::int64_t changes = 0;       ///< how often bodies came, went or changed hands since set-up
  double elapsed = 0.0;           ///< [s] in which they did so at this tick: World::advance
  std::vector<BodyState> bodies;  ///< by BodyId

  /// Copies another motion of the same bodies. Allocates nothing.
  void take(const Motion& other) noexcept {
    tick = other.tick;
    changes = other.changes;
    elapsed = other.elapsed;
    std::copy(other.bodies.begin(), other.bodies.end(), bodies.begin());
  }
};

/// A share of a force, 0 to 1, now and at the last tick.
struct Share {
  double now = 1.0;     ///< at this tick
  double before = 1.0;  ///< at the tick before

  /// There is a force, or there was one.
  [[nodiscard]] bool acts() const noexcept { return now > 0.0 || before > 0.0; }
  /// The share of two that both apply.
  friend Share operator*(const Share& a, const Share& b) noexcept {
    return {a.now * b.now, a.before * b.before};
  }
};

namespace detail {

/// The share of a held body's forces on its surroundings.
[[nodiscard]] inline Share held(const Presence& body) noexcept {
  return {std::max(0.0, body.grip.now), std::max(0.0, body.grip.before)};
}

/// The share between a loose body and another one, apart from whether they are there.
[[nodiscard]] inline Share share_by_grip(const Presence& loose, const BodyState& other) noexcept {
  if (!other.arm.valid()) return held(loose);
  if (other.arm != loose.holder || !other.spares_held) return {};
  return {std::max(0.0, -loose.grip.now), std::max(0.0, -loose.grip.before)};
}

/// The share between two loose bodies: those that lie free do not push each other, nor do those in
/// one hand.
[[nodiscard]] inline Share share_of_loose(const Presence& a, const Presence& b) noexcept {
  const Share of_a = held(a);
  const Share of_b = held(b);
  if (a.holder == b.holder) {
    return {std::abs(of_a.now - of_b.now), std::abs(of_a.before - of_b.before)};
  }
  return {std::max(of_a.now, of_b.now), std::max(of_a.before, of_b.before)};
}

}  // namespace detail

/// The share of their law's force that acts between two bodies; all of it unless one of them can
/// come and go. As long as bodies come, go and change hands over some time, it has no steps.
[[nodiscard]] inline Share share_between(const BodyState& a, const BodyState& b) noexcept {
  if (!a.is_loose && !b.is_loose) return {};
  const Presence& of_a = a.presence;
  const Presence& of_b = b.presence;
  Share share;
  if (a.is_loose) share = share * Share{of_a.there.now, of_a.there.before};
  if (b.is_loose) share = share * Share{of_b.there.now, of_b.there.before};
  if (a.is_loose && b.is_loose) return share * detail::share_of_loose(of_a, of_b);
  return share * (a.is_loose ? detail::share_by_grip(of_a, b) : detail::share_by_grip(of_b, a));
}

/// The body that forces on a body act on: the tool that holds it, or itself.
[[nodiscard]] inline BodyId carrier_of(const Motion& motion, BodyId body) noexcept {
  const BodyState& state = motion.bodies[static_cast<std::size_t>(body.index)];
  return state.is_loose && state.arm.valid() ? state.arm : body;
}

}  // namespace repel
