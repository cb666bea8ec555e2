// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The leverage of the operator: by how much a push at the tool outweighs a force on a link, and
/// force laws that allow for it.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/cell/description.hpp>
#include <repel/reduction/convex_shape.hpp>

namespace repel {

/// The greatest leverage that counts: a part so close to a joint is hardly moved by it.
inline constexpr double most_leverage = 10.0;

/// The law as it acts at a part over which the tool has this `leverage` [1], 1 or more. A law given
/// at the tool has its forces, its damping and so its stiffness multiplied by it, which leaves the
/// ratio of damping to stiffness as it was; one given at the part is returned unchanged.
[[nodiscard]] ForceLaw at_part(ForceLaw law, double leverage) noexcept;

namespace detail {

/// Calls `visit(n, Q)` with unit directions n perpendicular to the unit vector `axis` and the
/// points Q [m] of the core of the shape that are the farthest along them. @param first one of the
/// directions, perpendicular to `axis`
template <class Visit>
void for_each_side(const Shape& shape, const Pose& X_WP, const Vec3& axis, const Vec3& first,
                   const Visit& visit) {
  constexpr int sides = 24;
  // Two directions about each: one alone has no single farthest point on a flat side.
  constexpr double tilt = 1e-3;  // [rad]
  const Vec3 second = axis.cross(first);
  for (int side = 0; side < sides; ++side) {
    for (const double aside : {tilt, -tilt}) {
      const double turn = side * 2.0 * std::numbers::pi / sides + aside;
      const Vec3 n = std::cos(turn) * first + std::sin(turn) * second;
      const Vec<double> d = rotate_transposed(X_WP, Vec<double>(n[0], n[1], n[2]));
      visit(n, X_WP * to_vec3(shape.level(0).core.support(d).p));
    }
  }
}

/// A unit vector perpendicular to the unit vector `axis`, along `wish` as far as possible.
[[nodiscard]] Vec3 perpendicular(const Vec3& axis, const Vec3& wish) noexcept;

}  // namespace detail

/// The lever of a shape about a joint [m]: the greatest torque [N m] about the axis of the joint by
/// which a force of 1 N can push against the surface of the shape, across the axis. 1 for a joint
/// that slides. Too small by up to 4 percent: directions 15 degrees apart are tried.
/// @param column twist of the joint at 1 rad/s or 1 m/s, at the point `p_WC` [m]
[[nodiscard]] double lever_of(const Shape& shape, const Pose& X_WP, const Twist& column,
                              const Vec3& p_WC);

/// The distance [m] from the axis of a joint to the farthest point of the shape; infinite for a
/// joint that slides. Parameters and accuracy as above.
[[nodiscard]] double farthest_from_axis(const Shape& shape, const Pose& X_WP, const Twist& column,
                                        const Vec3& p_WC);

/// The levers of the tool and of the link parts of an arm about its joints, the greatest over poses
/// spread evenly over the ranges of the joints.
class ArmLevers {
 public:
  static constexpr int poses = 256;  ///< in which an arm is looked at

  ArmLevers() = default;
  /// Leaves the kinematics of the arm at its `start`. Nothing is computed for an arm without link
  /// parts. Cost: kinematics, and 48 support maps for each part and joint, in each of the poses:
  /// 20 ms for an arm of six joints.
  explicit ArmLevers(const ArmDescription& arm);

  /// The leverage of the tool over a part [1], 1 to `most_leverage`: the greatest ratio of their
  /// levers over the joints from `from` on that move the part. So much greater than a force at the
  /// tool must a force at the part be to hold it, where it is pushed at its greatest lever.
  /// @param part index in ArmDescription::parts @param meets [m] bound of the lever about the first
  /// joint
  [[nodiscard]] double leverage(int part, int from = 0,
                                double meets = std::numeric_limits<double>::infinity()) const;

  /// The same of two parts of the arm: over the outer one, about the joints between them.
  [[nodiscard]] double between(int part, int other) const;

  /// The bound above for parts that meet a shape fixed in the world: its farthest point from the
  /// axis of the first joint [m], which stands still.
  [[nodiscard]] double meeting(const Shape& shape, const Pose& X_WP) const;

 private:
  static constexpr double least_lever = 0.02;  // of that of the tool

  void add(const ArmDescription& arm, Jacobian& J);

  std::vector<int> links_;     // of each part
  std::vector<double> tool_;   // by joint
  std::vector<double> parts_;  // by part, then by joint
  Twist first_;                // of the first joint, at the start
  Vec3 p_WT_{0, 0, 0};         // [m] where `first_` is taken
};

}  // namespace repel
