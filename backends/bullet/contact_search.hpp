/// @file
/// Where the links of an arm touch obstacles, found by Bullet.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <span>
#include <vector>

#include <repel/world/contact.hpp>

namespace repel::bullet::detail {

/// A point at which a link reaches into an obstacle.
struct Touch {
  int link = 0;
  Vec3 p_W{0, 0, 0};    ///< [m]
  Vec3 out_W{0, 0, 0};  ///< unit, out of the obstacle
  double depth = 0.0;   ///< [m] above 0
};

/// The shapes of an arm and of its obstacles. What it answers depends on the poses alone: nothing
/// is kept from one search to the next.
class ContactSearch {
 public:
  /// More points than these at a time are not looked at.
  static constexpr std::size_t most_touches = 32;

  /// @throws SetupError naming the part that is out of range or a box or cylinder without thickness
  ContactSearch(const ArmModel& model, std::span<const ContactPart> parts);

  /// The points of contact with the links at `X_WL`. Cost: a comparison of boxes for each pair, and
  /// Bullet's query for those whose boxes meet.
  std::span<const Touch> find(std::span<const Pose> X_WL) noexcept;

 private:
  /// A shape where it is.
  struct Solid {
    int link = -1;
    Pose X_LP = Pose::Identity();
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btCollisionObject> object;
    btVector3 low, high;  // [m] of its box along the axes of the world
    void place(const Pose& X_WP);
  };

  std::vector<Solid> links_, obstacles_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btCollisionWorld world_;
  std::vector<Touch> touches_;
};

}  // namespace repel::bullet::detail
