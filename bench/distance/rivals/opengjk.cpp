// SPDX-License-Identifier: BSD-3-Clause
#include <openGJK/openGJK.h>

#undef restrict  // a keyword of C, which the header defines away in C++

#include <type_traits>

#include "rival.hpp"

/// openGJK's printf: it complains of searches that do not end on the output, where the tables go.
/// Whether such an answer is wrong, the checks find out.
extern "C" int repel_bench_unheard(const char*, ...) {
  return 0;
}

namespace repel::bench {

namespace {

static_assert(std::is_same_v<gkFloat, double>, "openGJK is measured in double");

/// A solid at its pose: openGJK knows no poses, only points through pointers to each.
class Body {
 public:
  Body(const Solid& s, const Pose& X_W) {
    for (const Vec3& v : s.vertices) points_W_.push_back(X_W * v);
    for (Vec3& p : points_W_) rows_.push_back(p.data());
  }
  [[nodiscard]] gkPolytope polytope() {
    return {
        .numpoints = static_cast<int>(rows_.size()), .s = {}, .s_idx = 0, .coord = rows_.data()};
  }

 private:
  std::vector<Vec3> points_W_;
  std::vector<double*> rows_;
};

class OpenGjk {
 public:
  struct Result {
    double distance;
    gkSimplex simplex;
  };

  OpenGjk(const Task& task, double) : task_(task) {
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = bodies_.emplace_back();
      for (std::size_t i = 0; i < X_W.size(); ++i) placed.emplace_back(task.solids[i], X_W[i]);
    }
  }

  Result cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    std::vector<Body>& bodies = bodies_[ask.tick];
    Result r;
    r.simplex.nvrtx = 0;
    r.distance = compute_minimum_distance(bodies[a].polytope(), bodies[b].polytope(), &r.simplex);
    return r;
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    const auto& [p_WA, p_WB] = r.simplex.witnesses;
    const Vec3 v = Eigen::Map<const Vec3>(p_WA) - Eigen::Map<const Vec3>(p_WB);
    return {.distance = r.distance, .extraction_W = v.normalized()};
  }

 private:
  const Task& task_;
  std::vector<std::vector<Body>> bodies_;
};

const Enlisted enlisted({
    .name = "opengjk",
    .version = REPEL_RIVAL_VERSION " double",
    .settings = "compute_minimum_distance of the scalar library, compiled here; it takes points "
                "without a pose, which are moved before the clock starts; tolerance and number of "
                "steps are fixed; it has no depths and keeps nothing from tick to tick",
    .tolerance = 0.0,
    .sweeps = false,
    .warms = false,
    .depths = false,
    .load = Adapter<OpenGjk>::load,
});

}  // namespace

}  // namespace repel::bench
