// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds contacts between the links of an arm and obstacles, using Bullet.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <span>
#include <vector>

#include <repel/simulated/contact.hpp>

namespace repel::bullet::detail {

/// A contact point at which a link penetrates an obstacle.
struct Touch {
  int link = 0;
  Vec3 p_W{0, 0, 0};    ///< [m]
  Vec3 out_W{0, 0, 0};  ///< unit, outward normal of the obstacle
  double depth = 0.0;   ///< [m] penetration depth, > 0
};

/// The shapes of an arm and of its obstacles. Stateless: the result depends on the poses alone.
class ContactSearch {
 public:
  /// Maximum number of contact points; further ones are ignored.
  static constexpr std::size_t most_touches = 32;

  /// @throws SetupError naming the part that is out of range, or a box or cylinder without
  ///   thickness
  ContactSearch(const ArmModel& model, std::span<const ContactPart> parts);

  /// The contact points with the links at `X_WL`. Cost: a bounding-box test for each pair of link
  /// part and obstacle, and a Bullet query for each pair whose boxes overlap.
  std::span<const Touch> find(std::span<const Pose> X_WL) noexcept;

 private:
  /// A shape and its current pose.
  struct Solid {
    int link = -1;
    Pose X_LP = Pose::Identity();
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btCollisionObject> object;
    btVector3 low, high;  // [m] axis-aligned bounding box in the world
    void place(const Pose& X_WP);
  };

  std::vector<Solid> links_, obstacles_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btCollisionWorld world_;
  std::vector<Touch> touches_;
};

}  // namespace repel::bullet::detail
