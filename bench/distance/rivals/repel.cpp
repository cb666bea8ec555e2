#include <repel/repel.hpp>

#include "rival.hpp"

namespace repel::bench {

namespace {

/// Every answer is exactly one call of `separation`.
class Repel {
 public:
  Repel(const Task& task, double tolerance) : task_(task), warm_(task.pairs.size()) {
    options_.tolerance = tolerance;
    for (const Solid& s : task.solids) {
      shapes_.push_back(s.box ? Shape::box(s.half_extents) : Shape::hull(s.vertices, levels(s)));
    }
  }

  Separation cold(const Ask& ask) noexcept {
    const auto& [a, b] = task_.pairs[ask.pair];
    const std::vector<Pose>& X_W = task_.X_W[ask.tick];
    return separation(shapes_[a], X_W[a], shapes_[b], X_W[b], options_);
  }
  Separation warm(const Ask& ask) noexcept {
    const auto& [a, b] = task_.pairs[ask.pair];
    const std::vector<Pose>& X_W = task_.X_W[ask.tick];
    return separation(shapes_[a], X_W[a], shapes_[b], X_W[b], options_, warm_[ask.pair]);
  }
  static Answer read(const Separation& s) { return {s.distance, s.lower, s.upper}; }

 private:
  // Levels are for overlap: large hulls are asked about gaps only, and load faster with one.
  static ReductionOptions levels(const Solid& s) {
    return s.vertices.size() > 64 ? ReductionOptions{.levels = 1} : ReductionOptions{};
  }

  const Task& task_;
  QueryOptions options_;
  std::vector<Shape> shapes_;
  std::vector<WarmStart> warm_;
};

const Enlisted enlisted({
    .name = "repel",
    .version = REPEL_VERSION,
    .settings = "separation() with default options; warm: the WarmStart of the pair",
    .tolerance = QueryOptions{}.tolerance,
    .exact_depths = false,
    .load = Adapter<Repel>::load,
});

}  // namespace

}  // namespace repel::bench
