// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Sums over pairs: forces and totals at one tick, and per-pair extremes since set-up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/spatial.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Counts and extremes of some pairs, or of all, at one tick. Walls and passable
/// bodies alike: the law of the pair tells them apart.
struct PairTotals {
  int near = 0;                 ///< pairs that may be within range; all with `every_pair`
  int evaluated = 0;            ///< near pairs evaluated at this tick
  int stale = 0;                ///< near pairs not evaluated: force from a bound by the last answer
  std::int64_t oldest_age = 0;  ///< [ticks] longest wait of a stale pair for an evaluation
  std::int64_t iterations = 0;  ///< support-map pairs evaluated
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  PairId nearest_pair;                          ///< that of `nearest`
  double deepest = 0.0;     ///< [m] proven upper bound of the penetration of all evaluated pairs
  double peak_force = 0.0;  ///< [N] largest of one pair
  PairId hardest_pair;      ///< the pair of `peak_force`; invalid while no pair exerts a force
  int crowded = 0;  ///< pairs without a slot: the memory (`Capacities::candidates`) was full
  int expired = 0;  ///< stale pairs older than `Budget::max_age`: their force fades out
  /// [J] Sum over stale pairs that were evaluated again: potential of the law at the assumed
  /// distance minus that at the distance found. Upper bound of the energy their forces have added.
  double refresh_energy = 0.0;

  /// Updates `peak_force` with the force of a pair [N].
  void note_force(double force, PairId pair) noexcept {
    if (!(force > peak_force)) return;
    peak_force = force;
    hardest_pair = pair;
  }

  /// Adds those of other pairs at the same tick.
  void add(const PairTotals& other) noexcept {
    near += other.near;
    evaluated += other.evaluated;
    stale += other.stale;
    oldest_age = std::max(oldest_age, other.oldest_age);
    iterations += other.iterations;
    if (other.nearest < nearest) {
      nearest = other.nearest;
      nearest_pair = other.nearest_pair;
    }
    deepest = std::max(deepest, other.deepest);
    note_force(other.peak_force, other.hardest_pair);
    crowded += other.crowded;
    expired += other.expired;
    refresh_energy += other.refresh_energy;
  }
};

/// The forces of a set of pairs at one tick.
struct PairForces {
  std::int64_t tick = -1;       ///< of the motion they belong to
  std::vector<Wrench> on_body;  ///< [N, N m] by BodyId, about each body's origin, world axes; of
                                ///< bodies that are not of the same arm
  /// The same, of bodies of the same arm. These are internal forces: they bring in no external
  /// power.
  std::vector<Wrench> from_own;
  bool has_own = false;  ///< some of `from_own` may differ from zero
  /// [W] by BodyId: the power delivered to it by the motion of the bodies acting on it that are not
  /// of the same arm, the sum of f.v at the contact points, v of the other body. Bodies at rest add
  /// nothing.
  std::vector<double> carried;
  PairTotals totals;  ///< of all pairs

  PairForces() = default;
  /// No forces. Allocates for so many bodies.
  explicit PairForces(int bodies) : on_body(bodies), from_own(bodies), carried(bodies, 0.0) {}

  /// Back to no forces. Does not allocate.
  void clear() noexcept {
    std::fill(on_body.begin(), on_body.end(), Wrench{});
    std::fill(carried.begin(), carried.end(), 0.0);
    if (has_own) std::fill(from_own.begin(), from_own.end(), Wrench{});
    has_own = false;
    totals = {};
  }

  /// Adds the equal and opposite forces between A and B, each about the origin of its own body.
  /// Those on a body that a tool holds are on the tool.
  void push(BodyId a, BodyId b, const Wrench& on_a, const Wrench& on_b,
            const Motion& motion) noexcept {
    const BodyId arm = motion.bodies[a.index].arm;
    if (arm.valid() && arm == motion.bodies[b.index].arm) {
      add_to(from_own, a, on_a, motion);
      add_to(from_own, b, on_b, motion);
      has_own = true;
      return;
    }
    add_to(on_body, a, on_a, motion);
    add_to(on_body, b, on_b, motion);
    carried[carrier_of(motion, a).index] -= power(on_b, motion.bodies[b.index].V_WB);
    carried[carrier_of(motion, b).index] -= power(on_a, motion.bodies[a.index].V_WB);
  }

  /// Adds the `energy` [J] by which the potential of a pair has grown since the last tick because
  /// its parts come or go: it is supplied to the arm that can draw it, to each of two a half.
  void supply(BodyId a, BodyId b, double energy, const Motion& motion) noexcept {
    if (energy == 0.0 || !(motion.elapsed > 0.0)) return;
    const double power = energy / motion.elapsed;
    const BodyId of_a = motion.bodies[a.index].arm;
    const BodyId of_b = motion.bodies[b.index].arm;
    if (of_a == of_b) return;  // of one arm, or of none
    const double each = of_a.valid() && of_b.valid() ? 0.5 * power : power;
    if (of_a.valid()) carried[carrier_of(motion, a).index] += each;
    if (of_b.valid()) carried[carrier_of(motion, b).index] += each;
  }

  /// Adds the forces of other pairs of the same world at the same tick.
  void add(const PairForces& other) noexcept {
    for (std::size_t i = 0; i < on_body.size(); ++i) {
      on_body[i] += other.on_body[i];
      carried[i] += other.carried[i];
    }
    if (other.has_own) {
      for (std::size_t i = 0; i < from_own.size(); ++i) from_own[i] += other.from_own[i];
      has_own = true;
    }
    totals.add(other.totals);
  }

 private:
  static void add_to(std::vector<Wrench>& wrenches, BodyId body, const Wrench& F,
                     const Motion& motion) noexcept {
    const BodyId on = carrier_of(motion, body);
    if (on == body) {
      wrenches[body.index] += F;
      return;
    }
    const Vec3 to_carrier =
        origin(motion.bodies[on.index].X_WB) - origin(motion.bodies[body.index].X_WB);
    wrenches[on.index] += moved_to(F, to_carrier);
  }
};

/// The extremes of one pair, or of several, since set-up.
struct PairExtremes {
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  double peak_force = 0.0;                      ///< [N]
  double deepest = 0.0;  ///< [m] proven upper bound of the penetration at all evaluations

  /// Takes the extremes of both.
  void add(const PairExtremes& other) noexcept {
    nearest = std::min(nearest, other.nearest);
    peak_force = std::max(peak_force, other.peak_force);
    deepest = std::max(deepest, other.deepest);
  }
};

}  // namespace repel
