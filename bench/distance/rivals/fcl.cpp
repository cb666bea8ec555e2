#include <fcl/config.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_indep.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include "rival.hpp"

namespace repel::bench {

namespace {

using fcl::detail::GJKSolver_indep;
using fcl::detail::GJKSolver_libccd;

/// FCL with one of its two solvers, called without the dispatch of fcl::distance.
template <class Solver>
class Fcl {
 public:
  static constexpr bool is_libccd = std::is_same_v<Solver, GJKSolver_libccd<double>>;

  struct Result {
    double distance;
    Vec3 p_WA, p_WB;
  };

  Fcl(const Task& task, double tolerance) : task_(task), guesses_(task.pairs.size(), {1, 0, 0}) {
    for (const Solid& s : task.solids) shapes_.push_back(shape(s));
    if constexpr (is_libccd) {
      solver_.distance_tolerance = tolerance;
      solver_.collision_tolerance = tolerance;
    } else {
      solver_.gjk_tolerance = tolerance;
      solver_.epa_tolerance = tolerance;
    }
  }

  Result cold(const Ask& ask) { return query(ask); }
  Result warm(const Ask& ask) {
    if constexpr (is_libccd) return query(ask);
    solver_.enableCachedGuess(true);
    solver_.setCachedGuess(guesses_[ask.pair]);
    const Result r = query(ask);
    guesses_[ask.pair] = solver_.getCachedGuess();
    solver_.enableCachedGuess(false);
    return r;
  }
  static Answer read(const Result& r) { return {.distance = r.distance}; }

 private:
  static std::shared_ptr<fcl::ShapeBased> shape(const Solid& s) {
    if (s.box) return std::make_shared<fcl::Boxd>(Vec3(2.0 * s.half_extents));
    auto vertices = std::make_shared<std::vector<Vec3>>(s.vertices);
    auto faces = std::make_shared<std::vector<int>>();
    const auto found = triangles(s);
    for (const auto& [i, j, k] : found) faces->insert(faces->end(), {3, i, j, k});
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(found.size()), faces, true);
  }

  template <class A, class B>
  Result query(const fcl::ShapeBased& a, const Pose& X_WA, const fcl::ShapeBased& b,
               const Pose& X_WB) {
    Result r;
    const A& A_shape = static_cast<const A&>(a);
    const B& B_shape = static_cast<const B&>(b);
    if (task_.overlap) {
      solver_.shapeSignedDistance(A_shape, X_WA, B_shape, X_WB, &r.distance, &r.p_WA, &r.p_WB);
    } else {
      solver_.shapeDistance(A_shape, X_WA, B_shape, X_WB, &r.distance, &r.p_WA, &r.p_WB);
    }
    return r;
  }

  Result query(const Ask& ask) {
    const auto& [ia, ib] = task_.pairs[ask.pair];
    const fcl::ShapeBased& a = *shapes_[ia];
    const fcl::ShapeBased& b = *shapes_[ib];
    const std::vector<Pose>& X_W = task_.X_W[ask.tick];
    const bool box_a = task_.solids[ia].box;
    const bool box_b = task_.solids[ib].box;
    if (box_a && box_b) return query<fcl::Boxd, fcl::Boxd>(a, X_W[ia], b, X_W[ib]);
    if (box_a) return query<fcl::Boxd, fcl::Convexd>(a, X_W[ia], b, X_W[ib]);
    if (box_b) return query<fcl::Convexd, fcl::Boxd>(a, X_W[ia], b, X_W[ib]);
    return query<fcl::Convexd, fcl::Convexd>(a, X_W[ia], b, X_W[ib]);
  }

  const Task& task_;
  Solver solver_;
  std::vector<std::shared_ptr<fcl::ShapeBased>> shapes_;
  std::vector<Vec3> guesses_;
};

const Enlisted with_libccd({
    .name = "fcl",
    .version = FCL_VERSION,
    .settings = "GJKSolver_libccd (its default): shapeDistance, shapeSignedDistance in overlap, "
                "without the dispatch of fcl::distance; keeps nothing from tick to tick",
    .tolerance = 1e-6,
    .warms = false,
    .load = Adapter<Fcl<GJKSolver_libccd<double>>>::load,
});

const Enlisted independent({
    .name = "fcl_indep",
    .version = FCL_VERSION,
    .settings = "GJKSolver_indep, called likewise; warm: cached guess",
    .tolerance = 1e-6,
    .load = Adapter<Fcl<GJKSolver_indep<double>>>::load,
});

}  // namespace

}  // namespace repel::bench
