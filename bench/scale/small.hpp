// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The small scene: 4 tool parts and 8 obstacles, the task `tick` of distance_bench.
#pragma once

#include <string>
#include <vector>

namespace repel::scale {

/// Ticks of the small scene, by the coprocessor or by the warm queries of another library.
struct SmallRun {
  std::string who;
  double p50 = 0.0;        ///< [ns] per tick
  double p99 = 0.0;        ///< [ns]
  double near = 0.0;       ///< pairs within range, mean per tick
  double evaluated = 0.0;  ///< mean per tick
  int wrong = 0;           ///< distances within range with a relative error above 1e-6
};

/// repel with every pair near, repel with 3 near on average, and each rival on all pairs, warm,
/// interleaved tick by tick. Rivals are called as in distance_bench.
[[nodiscard]] std::vector<SmallRun> small_runs(int rounds, const std::vector<std::string>& rivals);

}  // namespace repel::scale
