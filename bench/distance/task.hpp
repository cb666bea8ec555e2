// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The tasks given to every library: solids, their poses tick by tick, and the exact answers.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <support/families.hpp>

namespace repel::bench {

using Solid = families::Solid;

/// A pair of solids, by their indices.
struct Pair {
  std::size_t a = 0;
  std::size_t b = 0;
};

/// One query: a pair at a tick.
struct Ask {
  std::size_t pair = 0;
  std::size_t tick = 0;
};

/// The exact answer to one query.
struct Truth {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the penetration depth
  double size = 0.0;      ///< [m] of the larger solid: largest distance of a vertex from its origin
};

/// Solids moving through `ticks` poses, forth and back, so that every query is one tick of motion
/// after the previous one on the same pair.
struct Task {
  std::string name;
  std::vector<Solid> solids;
  std::vector<Pair> pairs;
  std::vector<std::vector<Pose>> X_W;  ///< [tick][solid]
  std::size_t batch = 32;  ///< queries timed together: one alone is too short for the clock
  bool overlap = false;    ///< every pair overlaps at every tick; otherwise none does

  [[nodiscard]] std::size_t ticks() const { return X_W.size(); }
  /// All queries, tick by tick, forward and backward.
  [[nodiscard]] std::vector<Ask> asks() const;
};

/// The names of all tasks, in the order of the table.
[[nodiscard]] const std::vector<std::string>& task_names();

/// Draws the task of that name; `quick` reduces it to a tenth of the pairs. The same on every
/// machine. Throws std::invalid_argument for a name that is not in task_names().
[[nodiscard]] Task make_task(std::string_view name, bool quick);

/// A box of 0.2 m to 1 m, or, if `vertices` is not 0, the hull of that many points on a sphere 1 m
/// in diameter.
[[nodiscard]] Solid draw_solid(families::Rng& rng, int vertices);

/// `count` pairs of such solids at random poses that overlap by a millimetre or more.
[[nodiscard]] Task overlap_task(int vertices, int count);

/// The exact answers, [tick * pairs + pair]. Throws std::runtime_error if 113-bit arithmetic cannot
/// prove one. Cost: milliseconds per query.
[[nodiscard]] std::vector<Truth> exact_answers(const Task& task);

/// [m] An interior point: the origin if it is inside, else the mean of the vertices.
[[nodiscard]] Vec3 centre(const Solid& solid);

/// The outward-oriented triangles of a hull, for libraries that need faces; a box has none.
[[nodiscard]] std::vector<std::array<int, 3>> triangles(const Solid& solid);

}  // namespace repel::bench
