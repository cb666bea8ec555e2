// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// repel as a measured library.
#pragma once

#include <repel/repel.hpp>
#include <repel/schedule/separations.hpp>

#include "rival.hpp"

namespace repel::bench {

/// One query, as a program makes it that is compiled for this machine, or for any.
inline Separation query(PosedShape a, PosedShape b, const QueryOptions& options,
                        WarmStart& warm) noexcept {
#ifdef REPEL_BENCH_NATIVE
  return separation(a.shape, a.X_W, b.shape, b.X_W, options, warm);
#else
  const PosedShapes pair{a, b};
  Separation found;
  separations({&pair, 1}, options, {&warm, 1}, {&found, 1});
  return found;
#endif
}

/// Every answer is exactly one query.
class Repel {
 public:
  Repel(const Task& task, const QueryOptions& options, const ReductionOptions& reduction)
      : task_(task), options_(options), warm_(task.pairs.size()) {
    for (const Solid& s : task.solids) {
      shapes_.push_back(s.box ? Shape::box(s.half_extents, reduction)
                              : Shape::hull(s.vertices, levels(s, reduction)));
    }
  }

  Separation cold(const Ask& ask) noexcept {
    const auto& [a, b] = task_.pairs[ask.pair];
    const std::vector<Pose>& X_W = task_.X_W[ask.tick];
    WarmStart cold;
    return query({shapes_[a], X_W[a]}, {shapes_[b], X_W[b]}, options_, cold);
  }
  Separation warm(const Ask& ask) noexcept {
    const auto& [a, b] = task_.pairs[ask.pair];
    const std::vector<Pose>& X_W = task_.X_W[ask.tick];
    return query({shapes_[a], X_W[a]}, {shapes_[b], X_W[b]}, options_, warm_[ask.pair]);
  }
  static Answer read(const Separation& s) { return {s.distance, s.lower, s.upper, s.extraction_W}; }

 private:
  // Levels serve overlap only: large hulls occur only in gap tasks, and load faster with one level.
  static ReductionOptions levels(const Solid& s, const ReductionOptions& reduction) {
    return s.vertices.size() > 64 ? ReductionOptions{.levels = 1} : reduction;
  }

  const Task& task_;
  QueryOptions options_;
  std::vector<Shape> shapes_;
  std::vector<WarmStart> warm_;
};

}  // namespace repel::bench
