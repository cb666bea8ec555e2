// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The settings of repel: every method by which `separation` measures an overlap.

#include "rivals/repel.hpp"

namespace repel::bench {

namespace {

void add(const std::string& name, Measure measure, int levels, bool exact) {
  const auto load = [=](const Task& task, double tolerance) -> std::unique_ptr<Rival> {
    return std::make_unique<Adapter<Repel>>(
        task, QueryOptions{.tolerance = tolerance, .measure = measure},
        ReductionOptions{.levels = levels});
  };
  libraries().push_back({
      .name = name,
      .version = REPEL_VERSION,
      .settings = "separation(), warm: the WarmStart of the pair",
      .tolerance = QueryOptions{}.tolerance,
      .exact_depths = exact,
      .ours = true,
      .load = load,
  });
}

const bool added = [] {
  for (const int levels : {1, 2, 4, 8, 16, 32}) {
    add("reduction " + std::to_string(levels), Measure::reduction, levels, false);
  }
  add("deepest point", Measure::deepest_point, ReductionOptions{}.levels, false);
  add("exact", Measure::exact, ReductionOptions{}.levels, true);
  return true;
}();

}  // namespace

}  // namespace repel::bench
