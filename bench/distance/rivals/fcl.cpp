// SPDX-License-Identifier: BSD-3-Clause
#include <fcl/config.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include "rival.hpp"

namespace repel::bench {

namespace {

class Fcl {
 public:
  struct Result {
    double distance;
    Vec3 p_WA, p_WB;
  };

  Fcl(const Task& task, double tolerance) : task_(task) {
    for (const Solid& s : task.solids) shapes_.push_back(shape(s));
    solver_.distance_tolerance = tolerance;
    solver_.collision_tolerance = tolerance;
  }

  Result cold(const Ask& ask) {
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
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    const Vec3 v = r.distance < 0.0 ? Vec3(r.p_WB - r.p_WA) : Vec3(r.p_WA - r.p_WB);
    return {.distance = r.distance, .extraction_W = v / v.norm()};
  }

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
    solver_.shapeSignedDistance(static_cast<const A&>(a), X_WA, static_cast<const B&>(b), X_WB,
                                &r.distance, &r.p_WA, &r.p_WB);
    return r;
  }

  const Task& task_;
  fcl::detail::GJKSolver_libccd<double> solver_;
  std::vector<std::shared_ptr<fcl::ShapeBased>> shapes_;
};

const Enlisted enlisted({
    .name = "fcl",
    .version = FCL_VERSION,
    .settings = "GJKSolver_libccd::shapeSignedDistance, without the dispatch of fcl::distance; "
                "GJKSolver_indep is slower and wrong more often; 1e-10 is as fast as the default "
                "1e-6 and right more often; keeps nothing from tick to tick",
    .tolerance = 1e-10,
    .warms = false,
    .load = Adapter<Fcl>::load,
});

}  // namespace

}  // namespace repel::bench
