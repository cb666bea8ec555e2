// SPDX-License-Identifier: BSD-3-Clause
#include "rivals/repel.hpp"

namespace repel::bench {

namespace {

std::unique_ptr<Rival> load(const Task& task, double tolerance) {
  return std::make_unique<Adapter<Repel>>(task, QueryOptions{.tolerance = tolerance},
                                          ReductionOptions{});
}

const Enlisted enlisted({
    .name = "repel",
    .version = REPEL_VERSION,
    .settings =
#ifdef REPEL_BENCH_NATIVE
        "separation() with default options; warm: the WarmStart of the pair",
#else
        "separations() of one pair, default options; warm: the WarmStart of the pair",
#endif
    .tolerance = QueryOptions{}.tolerance,
    .exact_depths = false,
    .ours = true,
    .load = load,
});

}  // namespace

}  // namespace repel::bench
