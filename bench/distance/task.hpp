/// @file
/// What is asked of every rival: solids, where they are tick by tick, and the exact answers.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <support/families.hpp>

namespace repel::bench {

using Solid = families::Solid;

/// Two solids that are asked about, by their indices.
struct Pair {
  std::size_t a = 0;
  std::size_t b = 0;
};

/// One question: which pair, at which tick.
struct Ask {
  std::size_t pair = 0;
  std::size_t tick = 0;
};

/// The exact answer to one question.
struct Truth {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the penetration depth
  double size = 0.0;      ///< [m] of the larger solid: its farthest vertex from its origin
};

/// Solids on their way through `ticks` poses, there and back again, so that every question is one
/// tick of motion after the one before on the same pair.
struct Task {
  std::string name;
  std::vector<Solid> solids;
  std::vector<Pair> pairs;
  std::vector<std::vector<Pose>> X_W;  ///< [tick][solid]
  std::size_t batch = 32;              ///< questions timed as one, too short for the clock alone
  bool overlap = false;                ///< every pair overlaps at every tick; else none does

  [[nodiscard]] std::size_t ticks() const { return X_W.size(); }
  /// All questions, tick by tick, forward and backward.
  [[nodiscard]] std::vector<Ask> asks() const;
};

/// The names of all tasks, in the order of the table.
[[nodiscard]] const std::vector<std::string>& task_names();

/// Draws the task of that name; `quick` asks for a tenth of the pairs. The same on every machine.
/// Throws std::invalid_argument for a name that is not in task_names().
[[nodiscard]] Task make_task(std::string_view name, bool quick);

/// A box of 0.2 m to 1 m, or, where `vertices` is not 0, the hull of so many points on a sphere
/// 1 m across.
[[nodiscard]] Solid draw_solid(families::Rng& rng, int vertices);

/// `count` pairs of such solids at random poses that overlap by a millimetre or more.
[[nodiscard]] Task overlap_task(int vertices, int count);

/// The exact answers, [tick * pairs + pair]. Throws std::runtime_error when 113 bits cannot prove
/// one. Cost: milliseconds a question.
[[nodiscard]] std::vector<Truth> exact_answers(const Task& task);

/// [m] A point inside: the origin where it is, else the mean of the vertices.
[[nodiscard]] Vec3 centre(const Solid& solid);

/// The outward triangles of a hull, for rivals that want faces; a box has none.
[[nodiscard]] std::vector<std::array<int, 3>> triangles(const Solid& solid);

}  // namespace repel::bench
