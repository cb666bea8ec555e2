/// @file
/// What pairs amount to: their forces and counts at one tick, their extremes since set-up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/spatial.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// What the pairs amount to in one tick, of a block or of the world.
struct PairTotals {
  int near = 0;                 ///< pairs that may be within range; all when all are evaluated
  int evaluated = 0;            ///< of these, asked anew
  int stale = 0;                ///< of these, answered from an older tick, widened
  std::int64_t oldest_age = 0;  ///< [ticks] that the longest of them is near without an answer
  std::int64_t iterations = 0;  ///< support-map pairs spent
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  PairId nearest_pair;
  double deepest = 0.0;     ///< [m] proven: of the pairs evaluated none is deeper
  double peak_force = 0.0;  ///< [N] of one pair
  PairId hardest_pair;      ///< that one; none while nothing pushes
  int crowded = 0;          ///< pairs that found no room in the memory of `Limits::candidates`
  int expired = 0;          ///< of the stale, older than `Budget::max_age`: their force fades
  /// [J] by which springs of stale pairs were bent farther than those of the true distance when
  /// they were answered again: what their widened forces can have given too much.
  double refresh_energy = 0.0;

  /// A pair pushes with `force` [N].
  void note_force(double force, PairId pair) noexcept {
    if (!(force > peak_force)) return;
    peak_force = force;
    hardest_pair = pair;
  }

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

/// How the workers keep up; all zero without threads.
struct WorkerReport {
  int stood_in = 0;                  ///< workers that were stood in for in this tick
  std::int64_t silence = 0;          ///< [ticks] in a row the worst of them has been stood in for
  std::int64_t ticks = 0;            ///< since set-up, in which some worker was stood in for
  std::int64_t longest_silence = 0;  ///< [ticks] in a row, since set-up
};

/// The forces of a set of pairs at one tick.
struct PairForces {
  std::int64_t tick = -1;       ///< of the motion they belong to
  std::vector<Wrench> on_body;  ///< [N, N m] by BodyId, about each body's origin, world axes
  /// [W] by BodyId: what the bodies that push it give by their own motion, the sum of f.v at the
  /// points where they push. 0 for what only bodies that stand push.
  std::vector<double> carried;
  PairTotals totals;

  PairForces() = default;
  explicit PairForces(int bodies) : on_body(bodies), carried(bodies, 0.0) {}

  void clear() noexcept {
    std::fill(on_body.begin(), on_body.end(), Wrench{});
    std::fill(carried.begin(), carried.end(), 0.0);
    totals = {};
  }

  /// A and B push each other with opposite forces, each given about the origin of its body.
  void push(BodyId a, BodyId b, const Wrench& on_a, const Wrench& on_b,
            const Motion& motion) noexcept {
    on_body[a.index] += on_a;
    on_body[b.index] += on_b;
    carried[a.index] -= power(on_b, motion.bodies[b.index].V_WB);
    carried[b.index] -= power(on_a, motion.bodies[a.index].V_WB);
  }

  /// Those of other pairs of the same world at the same tick.
  void add(const PairForces& other) noexcept {
    for (std::size_t i = 0; i < on_body.size(); ++i) {
      on_body[i] += other.on_body[i];
      carried[i] += other.carried[i];
    }
    totals.add(other.totals);
  }
};

/// The extremes of one pair since set-up.
struct PairExtremes {
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  double peak_force = 0.0;                      ///< [N]
  double deepest =
      0.0;  ///< [m] proven: when it was asked, the parts were never deeper in each other

  void add(const PairExtremes& other) noexcept {
    nearest = std::min(nearest, other.nearest);
    peak_force = std::max(peak_force, other.peak_force);
    deepest = std::max(deepest, other.deepest);
  }
};

}  // namespace repel
