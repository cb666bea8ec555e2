// SPDX-License-Identifier: BSD-3-Clause
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <cmath>

#include "rival.hpp"

namespace repel::bench {

namespace {

btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

class Bullet {
 public:
  Bullet(const Task& task, double) : task_(task) {
    for (const Solid& s : task.solids) shapes_.push_back(shape(s));
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = X_W_.emplace_back();
      for (const Pose& X : X_W) {
        const Mat3& R = X.linear();
        placed.emplace_back(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2),
                                        R(2, 0), R(2, 1), R(2, 2)),
                            to_bullet(X.translation()));
      }
    }
  }

  btPointCollector cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    btGjkPairDetector detector(shapes_[a].get(), shapes_[b].get(), &simplex_, &depth_);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = X_W_[ask.tick][a];
    input.m_transformB = X_W_[ask.tick][b];
    btPointCollector closest;
    detector.getClosestPointsNonVirtual(input, closest, nullptr);
    return closest;
  }
  btPointCollector warm(const Ask& ask) { return cold(ask); }
  static Answer read(const btPointCollector& closest) {
    if (!closest.m_hasResult) return {.distance = std::nan("")};
    const btVector3& n = closest.m_normalOnBInWorld;
    return {.distance = closest.m_distance, .extraction_W = {n.x(), n.y(), n.z()}};
  }

 private:
  static std::unique_ptr<btConvexShape> shape(const Solid& s) {
    if (s.box) {
      auto box = std::make_unique<btBoxShape>(to_bullet(s.half_extents));
      box->setMargin(0.0);
      return box;
    }
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : s.vertices) hull->addPoint(to_bullet(v), false);
    hull->recalcLocalAabb();
    hull->setMargin(0.0);
    return hull;
  }

  const Task& task_;
  std::vector<std::unique_ptr<btConvexShape>> shapes_;
  std::vector<std::vector<btTransform>> X_W_;
  btVoronoiSimplexSolver simplex_;
  btGjkEpaPenetrationDepthSolver depth_;
};

const Enlisted enlisted({
    .name = "bullet",
    .version = "3.24 double",
    .settings = "btGjkPairDetector, Voronoi simplex solver, GJK-EPA for depths, margins 0; its "
                "tolerance is fixed, and it forgets the separating axis at each call",
    .tolerance = 0.0,
    .sweeps = false,
    .warms = false,
    .load = Adapter<Bullet>::load,
});

}  // namespace

}  // namespace repel::bench
