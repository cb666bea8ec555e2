/// @file
/// The small scene: 4 parts of a tool among 8 obstacles, the task `tick` of distance_bench.
#pragma once

#include <string>
#include <vector>

namespace repel::scale {

/// A tick of the small scene, by the coprocessor or by the warm queries of another library.
struct SmallRun {
  std::string who;
  double p50 = 0.0;        ///< [ns] a tick
  double p99 = 0.0;        ///< [ns]
  double near = 0.0;       ///< pairs within range, mean of a tick
  double evaluated = 0.0;  ///< mean of a tick
  int wrong = 0;           ///< distances within range that are off by more than 1e-6 of themselves
};

/// Ours with every pair near, ours with 3 in the mean, and each rival with all, warm, tick by tick
/// in turn. Rivals are asked as distance_bench asks them.
[[nodiscard]] std::vector<SmallRun> small_runs(int rounds, const std::vector<std::string>& rivals);

}  // namespace repel::scale
