/// @file
/// A way on a scene: timed first, tick by tick, and checked after.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "method.hpp"

namespace repel::scale {

/// How what was found compares with what another way has found.
struct Check {
  std::int64_t ticks = 0;    ///< compared
  std::int64_t wrong = 0;    ///< of these, with other forces or other pairs within range
  std::int64_t bitwise = 0;  ///< of these, with every number the same to the last bit
  double worst = 0.0;        ///< largest difference of two numbers [N, N m]

  [[nodiscard]] bool equal() const { return wrong == 0; }
};

/// A way that was measured on a scene.
struct Run {
  Way way;
  std::vector<double> ns{};  ///< of each tick
  /// Of each tick: how often the thread lost its processor in it, and the page faults.
  std::vector<int> lost{}, faults{};
  double evaluated = 0.0;  ///< mean of a tick
  double setup = 0.0;      ///< [s]
  double bytes = 0.0;      ///< that the heap has grown by from before set-up to after
  Record record{};
  Check check{};       ///< with the truth
  Check every_pair{};  ///< with ours that evaluates every pair at every tick

  [[nodiscard]] double mean() const;
  [[nodiscard]] double percentile(double share) const;
  /// The same over ticks without either; 0 where there are none.
  [[nodiscard]] double undisturbed(double share) const;
  [[nodiscard]] int preempted() const;  ///< ticks
  [[nodiscard]] int page_faults() const;
};

/// Loads the scene, and times its first `ticks`. What is kept for the check is written between two
/// ticks, a few hundred bytes each.
[[nodiscard]] Run measure(const Way& way, const Scene& scene, int ticks);

/// What the plain way has found at every tick of the scene.
struct Truth {
  Record record;
  std::int64_t ticks = 0;
  std::int64_t asked = 0;        ///< pairs, of all ticks: those whose spheres were within range
  std::int64_t overlapping = 0;  ///< of these, in overlap

  [[nodiscard]] double near() const {
    return static_cast<double>(record.within.size()) / static_cast<double>(ticks);
  }
};
[[nodiscard]] Truth truth_of(const Scene& scene, int ticks);

/// Compares forces where both have forces, else the pairs within range, for as many ticks as both
/// have.
[[nodiscard]] Check compare(const Record& record, const Record& truth, std::size_t bodies);

}  // namespace repel::scale
