// SPDX-License-Identifier: BSD-3-Clause
#include <box3d/collision.h>

#include "rival.hpp"

namespace repel::bench {

namespace {

b3Vec3 rounded(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

class Box3D {
 public:
  using Result = b3DistanceOutput;

  Box3D(const Task& task, double) : pairs_(task.pairs.size()), caches_(task.pairs.size()) {
    for (const Solid& s : task.solids) {
      auto& points = points_.emplace_back();
      for (const Vec3& v : s.vertices) points.push_back(rounded(v));
    }
    // It asks for the pose of B in A: a difference that is taken before it is rounded to floats.
    for (const std::vector<Pose>& X_W : task.X_W) {
      for (const auto& [a, b] : task.pairs) {
        const Pose X_AB = X_W[a].inverse() * X_W[b];
        const Eigen::Quaterniond q(X_AB.linear());
        inputs_.push_back({.proxyA = proxy(a),
                           .proxyB = proxy(b),
                           .transform = {.p = rounded(X_AB.translation()),
                                         .q = {rounded(q.vec()), static_cast<float>(q.w())}},
                           .useRadii = false});
      }
    }
  }

  Result cold(const Ask& ask) {
    b3SimplexCache none{};
    return query(ask, none);
  }
  Result warm(const Ask& ask) { return query(ask, caches_[ask.pair]); }
  static Answer read(const Result& r) { return {.distance = r.distance}; }

 private:
  [[nodiscard]] b3ShapeProxy proxy(std::size_t i) const {
    return {points_[i].data(), static_cast<int>(points_[i].size()), 0.0F};
  }
  Result query(const Ask& ask, b3SimplexCache& cache) const {
    return b3ShapeDistance(&inputs_[ask.tick * pairs_ + ask.pair], &cache, nullptr, 0);
  }

  std::size_t pairs_;
  std::vector<std::vector<b3Vec3>> points_;
  std::vector<b3DistanceInput> inputs_;
  std::vector<b3SimplexCache> caches_;
};

const Enlisted enlisted({
    .name = "box3d",
    .version = REPEL_RIVAL_VERSION " float",
    .settings = "b3ShapeDistance, compiled here; it knows single precision only, so that every "
                "relative pose is rounded to it before the clock starts; warm: b3SimplexCache; its "
                "tolerance is fixed, and it has no depths",
    .tolerance = 0.0,
    .sweeps = false,
    .depths = false,
    .load = Adapter<Box3D>::load,
});

}  // namespace

}  // namespace repel::bench
