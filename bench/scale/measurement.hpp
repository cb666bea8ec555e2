// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A method measured on a scene: timed first, tick by tick, then checked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "method.hpp"

namespace repel::scale {

/// Comparison of the results with those of another method.
struct Check {
  std::int64_t ticks = 0;    ///< compared
  std::int64_t wrong = 0;    ///< of these, with different forces or pairs within range
  std::int64_t bitwise = 0;  ///< of these, bitwise equal
  double worst = 0.0;        ///< largest difference of two values [N, N m]

  [[nodiscard]] bool equal() const { return wrong == 0; }
};

/// A method with its measurement on a scene.
struct Run {
  Way way;
  std::vector<double> ns{};  ///< of each tick, of all measurements
  /// For each of these: involuntary context switches of the thread, and page faults.
  std::vector<int> lost{}, faults{};
  double evaluated = 0.0;  ///< mean per tick
  double setup = 0.0;      ///< [s]
  double bytes = 0.0;      ///< heap growth during set-up
  WorkerReport workers{};
  WorkerUsage usage{};
  Record record{};
  Check check{};       ///< against brute force
  Check every_pair{};  ///< against repel evaluating every pair at every tick

  /// Adds the times of another measurement of the same ticks.
  void add_times(const Run& again);
  [[nodiscard]] double mean() const;
  [[nodiscard]] double percentile(double share) const;
  /// The percentile over ticks without either; 0 if there are none.
  [[nodiscard]] double undisturbed(double share) const;
  [[nodiscard]] int preempted() const;  ///< number of ticks
  [[nodiscard]] int page_faults() const;
};

/// Loads the scene, and times its first `ticks`. Data for the check is stored between ticks, a few
/// hundred bytes each.
[[nodiscard]] Run measure(const Way& way, const Scene& scene, int ticks);

/// The results of the brute force at every tick of the scene.
struct Truth {
  Record record;
  std::int64_t ticks = 0;
  std::int64_t asked = 0;  ///< pairs queried, over all ticks: those whose spheres were within range
  std::int64_t overlapping = 0;  ///< of these, overlapping

  [[nodiscard]] double near() const {
    return static_cast<double>(record.within.size()) / static_cast<double>(ticks);
  }
};
[[nodiscard]] Truth truth_of(const Scene& scene, int ticks);

/// Compares forces if both have forces, else the pairs within range, over the ticks that both have.
/// @param more the record may have more pairs than are within range, but must have all that are
[[nodiscard]] Check compare(const Record& record, const Record& truth, std::size_t bodies,
                            bool more = false);

}  // namespace repel::scale
