/// @file
/// What pairs amount to: their forces and counts at one tick, their extremes since set-up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/spatial.hpp>

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
  double peak_force = 0.0;  ///< [N] of one pair
  int crowded = 0;          ///< pairs that found no room in the memory of `Limits::candidates`
  int expired = 0;          ///< of the stale, older than `Budget::max_age`: their force fades
  /// [J] by which springs of stale pairs were bent farther than those of the true distance when
  /// they were answered again: what their widened forces can have given too much.
  double refresh_energy = 0.0;

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
    peak_force = std::max(peak_force, other.peak_force);
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
  PairTotals totals;

  void clear() noexcept {
    std::fill(on_body.begin(), on_body.end(), Wrench{});
    totals = {};
  }
};

/// The extremes of one pair since set-up.
struct PairExtremes {
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  double peak_force = 0.0;                      ///< [N]
};

}  // namespace repel
