// SPDX-License-Identifier: BSD-3-Clause
#include "contact_search.hpp"

#include <repel/reduction/shape_mesh.hpp>

#include "multibody.hpp"

namespace repel::bullet::detail {
namespace {

/// [m] Bullet's collision margin of boxes and cylinders; it rounds their edges, within their faces.
constexpr double rounding = 1e-4;

std::unique_ptr<btCollisionShape> hull_of(std::span<const Vec3> points) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& p : points) hull->addPoint(to_bullet(p), false);
  hull->recalcLocalAabb();
  hull->setMargin(0.0);
  return hull;
}

std::unique_ptr<btCollisionShape> hull_of(const Convex& polytope) {
  std::vector<Vec3> corners;
  for (int i = 0; i < polytope.vertex_count(); ++i) {
    corners.push_back(to_vec3(polytope.place(static_cast<std::uint32_t>(i))));
  }
  return hull_of(corners);
}

template <class BulletShape, class... Sizes>
std::unique_ptr<btCollisionShape> with_margin(double margin, const Sizes&... sizes) {
  auto shape = std::make_unique<BulletShape>(sizes...);
  shape->setMargin(margin);
  return shape;
}

void require_thick(const ContactPart& part, const Vec3& size) {
  if (size.minCoeff() > 2.0 * rounding) return;
  throw SetupError("part '" + part.name + "' cannot be touched in Bullet; allowed: sizes above " +
                   to_text(2.0 * rounding) + " m");
}

std::unique_ptr<btCollisionShape> bullet_shape(const ContactPart& part) {
  const Level& level = part.shape.level(0);
  const Vec3 size = core_extents(part.shape);
  switch (level.core.kind()) {  // a kind that is missing here does not compile
    case Convex::Kind::polytope:
      return hull_of(level.core);
    case Convex::Kind::box:
      if (level.depth > 0.0) {
        if (size.z() > 0.0) return std::make_unique<btCapsuleShapeZ>(level.depth, 2.0 * size.z());
        return std::make_unique<btSphereShape>(level.depth);
      }
      require_thick(part, size);
      return with_margin<btBoxShape>(rounding, to_bullet(size));
    case Convex::Kind::cone:
      require_thick(part, size);
      return with_margin<btConeShapeZ>(0.0, size.x(), 2.0 * size.z());
    case Convex::Kind::cylinder:
      require_thick(part, size);
      return with_margin<btCylinderShapeZ>(rounding, to_bullet(size));
    case Convex::Kind::ellipsoid:  // Bullet has none
      return hull_of(mesh_of(part.shape).vertices);
  }
  throw SetupError("part '" + part.name + "' is of no kind");
}

btDefaultCollisionConstructionInfo small_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 16;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 16;
  return info;
}

/// Collects the contact points that Bullet finds between one link and one obstacle.
struct Notes : btCollisionWorld::ContactResultCallback {
  Notes(int on, std::vector<Touch>& to) : link(on), touches(to) {}
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const double depth = -point.getDistance();
    if (depth > 0.0 && touches.size() < ContactSearch::most_touches) {
      const btVector3& p = point.getPositionWorldOnB();
      const btVector3& n = point.m_normalWorldOnB;  // from the obstacle to the link
      touches.push_back({link, {p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, depth});
    }
    return 0.0;
  }
  int link;
  std::vector<Touch>& touches;
};

}  // namespace

void ContactSearch::Solid::place(const Pose& X_WP) {
  object->setWorldTransform(to_bullet(X_WP));
  shape->getAabb(object->getWorldTransform(), low, high);
}

ContactSearch::ContactSearch(const ArmModel& model, std::span<const ContactPart> parts)
    : configuration_(small_pools()),
      dispatcher_(&configuration_),
      world_(&dispatcher_, nullptr, &configuration_) {
  require_touchable(parts, model);
  for (const ContactPart& part : parts) {
    Solid& solid = (part.link < 0 ? obstacles_ : links_).emplace_back();
    solid.link = part.link;
    solid.X_LP = part.X_LP;
    solid.shape = bullet_shape(part);
    solid.object = std::make_unique<btCollisionObject>();
    solid.object->setCollisionShape(solid.shape.get());
    solid.place(part.X_LP);
  }
  touches_.reserve(most_touches);
}

std::span<const Touch> ContactSearch::find(std::span<const Pose> X_WL) noexcept {
  touches_.clear();
  for (Solid& part : links_) {
    part.place(X_WL[static_cast<std::size_t>(part.link)] * part.X_LP);
    Notes notes(part.link, touches_);
    for (const Solid& obstacle : obstacles_) {
      if (!TestAabbAgainstAabb2(part.low, part.high, obstacle.low, obstacle.high)) continue;
      world_.contactPairTest(part.object.get(), obstacle.object.get(), notes);
    }
  }
  return touches_;
}

}  // namespace repel::bullet::detail
