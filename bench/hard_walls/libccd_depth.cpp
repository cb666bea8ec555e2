// SPDX-License-Identifier: BSD-3-Clause
#include "libccd_depth.hpp"

#include <algorithm>
#include <cstddef>

#include <repel/cell/layout.hpp>

#ifdef REPEL_HAS_LIBCCD
#include <ccd/ccd.h>
#endif

namespace repel::hard_walls {
namespace {

#ifdef REPEL_HAS_LIBCCD

/// A part where it is: what libccd asks for its support.
struct Placed {
  const Shape& shape;
  Pose X_W;

  Placed(const World& world, PartId id)
      : shape(world.part(id).shape), X_W(detail::pose_of(world, world.part(id))) {}
};

void farthest(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const Placed& placed = *static_cast<const Placed*>(object);
  const Level& level = placed.shape.level(0);
  const Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
  const Vec3 local = placed.X_W.linear().transpose() * d;
  Vec3 p = placed.X_W * to_vec3(level.core.support(Vec<double>(local)).p);
  if (level.depth > 0.0) p += level.depth * d.normalized();
  for (int axis = 0; axis < 3; ++axis) point->v[axis] = p[axis];
}

double depth_of(const World& world, const Pair& pair) {
  const Placed a(world, pair.a);
  const Placed b(world, pair.b);
  if ((a.X_W.translation() - b.X_W.translation()).norm() > a.shape.reach() + b.shape.reach()) {
    return 0.0;
  }
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = farthest;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-6;
  ccd_real_t depth = 0.0;
  ccd_vec3_t out, at;
  const bool is_apart = ccdGJKPenetration(&a, &b, &ccd, &depth, &out, &at) != 0;
  return is_apart ? 0.0 : depth;
}

#else

double depth_of(const World&, const Pair&) {
  return 0.0;
}

#endif

}  // namespace

LibccdDepth::LibccdDepth(const Cell& cell) : cell_(cell), world_(cell.world()) {
  for (const ArmDescription& arm : cell.description().arms) kinematics_.emplace_back(arm.model);
}

void LibccdDepth::place(std::span<const ArmReadings> readings, double time) {
  for (const MovingBody& moving : cell_.moving()) (void)moving.place(world_, time);
  for (std::size_t i = 0; i < kinematics_.size(); ++i) {
    kinematics_[i].update(readings[i].q);
    (void)world_.place(cell_.layout(i).tool, kinematics_[i].X_WT(), {});
    for (const LinkBody& link : cell_.layout(i).links) {
      (void)world_.place(link.body, kinematics_[i].X_WL(link.link), {});
    }
  }
}

double LibccdDepth::at(std::span<const ArmReadings> readings, double time) {
  place(readings, time);
  double deepest = 0.0;
  for (const Pair& pair : world_.pairs()) {
    if (!pair.law.passable) deepest = std::max(deepest, depth_of(world_, pair));
  }
  return deepest;
}

}  // namespace repel::hard_walls
