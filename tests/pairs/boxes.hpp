// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A world of boxes, a random motion through it, and its forces by brute force.
#pragma once

#include <repel/contact/patch.hpp>
#include <repel/pairs/forces_and_totals.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/world/world.hpp>

#include <string>
#include <vector>

#include "support/families.hpp"

namespace repel::test {

inline bool is_finite(const PairForces& forces) {
  for (const Wrench& F : forces.on_body) {
    if (!repel::is_finite(F)) return false;
  }
  return true;
}

inline Pose random_pose(families::Rng& random, double within) {
  Pose X = Pose::Identity();
  X.linear() = families::rotation(random);
  for (int axis = 0; axis < 3; ++axis) {
    X.translation()[axis] = families::uniform(random, -within, within);
  }
  return X;
}

inline Shape random_box(families::Rng& random) {
  return Shape::box({families::uniform(random, 0.01, 0.08), families::uniform(random, 0.01, 0.08),
                     families::uniform(random, 0.01, 0.08)});
}

/// A box, a hull, a rounded shape or one with a curved rim.
inline Shape random_shape(families::Rng& random) {
  const int kind = families::count_between(random, 0, 4);
  const double radius = families::uniform(random, 0.01, 0.08);
  const double half_length = families::uniform(random, 0.01, 0.08);
  if (kind == 0) return Shape::sphere(radius);
  if (kind == 1) return Shape::capsule(radius, half_length);
  if (kind == 2) return Shape::cylinder(radius, half_length);
  if (kind == 3) return Shape::hull(families::cloud(random, 12, radius).vertices);
  return random_box(random);
}

/// A tool of `tool_parts` boxes among `obstacles` boxes within 0.4 m, and its random walk.
struct Boxes {
  World world;
  BodyId tool;
  families::Rng random;
  Pose X_WT = Pose::Identity();

  Boxes(int tool_parts, int obstacles, const ForceLaw& law, unsigned seed,
        Measure measure = QueryOptions{}.measure)
      : world({}, measure), random(seed) {
    tool = world.add_body("tool");
    std::vector<PartId> parts;
    for (int i = 0; i < tool_parts; ++i) {
      parts.push_back(world.add_part(tool, "tool part " + std::to_string(i), random_box(random),
                                     random_pose(random, 0.08)));
    }
    for (int i = 0; i < obstacles; ++i) {
      const PartId obstacle = world.add_part(World::fixed, "obstacle " + std::to_string(i),
                                             random_box(random), random_pose(random, 0.4));
      for (const PartId part : parts) world.add_pair(part, obstacle, law);
    }
  }

  /// One tick of up to 3 mm and 0.02 rad, sometimes a jump, kept near the obstacles.
  void move() {
    const bool leap = families::count_between(random, 0, 99) == 0;
    const double angle = families::uniform(random, 0.0, leap ? 1.0 : 0.02);
    X_WT.linear() = Eigen::Quaterniond(families::small_rotation(random, angle) * X_WT.linear())
                        .normalized()
                        .toRotationMatrix();
    X_WT.translation() +=
        families::uniform(random, 0.0, leap ? 0.2 : 0.003) * families::direction(random);
    X_WT.translation() *= std::min(1.0, 0.35 / std::max(1e-9, X_WT.translation().norm()));
    const Twist V{families::uniform(random, 0.0, 0.5) * families::direction(random),
                  families::uniform(random, 0.0, 1.0) * families::direction(random)};
    ++world.motion().tick;
    world.place(tool, X_WT, V);
  }
};

/// Three moving bodies and the fixed one; random pairs, some of them duplicated, their parts in
/// either order.
struct Crowd {
  World world;
  std::vector<BodyId> bodies{World::fixed};
  families::Rng random;

  explicit Crowd(unsigned seed, const Capacities& limits = {},
                 Shape (*draw)(families::Rng&) = random_box)
      : world(limits), random(seed) {
    for (int i = 0; i < 3; ++i) bodies.push_back(world.add_body("body"));
    std::vector<PartId> parts;
    for (const BodyId body : bodies) {
      for (int i = 0; i < 8; ++i) {
        const Shape shape = draw(random);
        parts.push_back(world.add_part(body, "part", shape, test::random_pose(random, 0.3)));
      }
    }
    for (int i = 0; i < 300; ++i) {
      const PartId a = parts[families::count_between(random, 0, 31)];
      const PartId b = parts[families::count_between(random, 0, 31)];
      if (world.part(a).body == world.part(b).body) continue;
      world.add_pair(a, b, {.range = families::uniform(random, 0.001, 0.05)});
    }
    for (const BodyId body : bodies) {
      if (body != World::fixed) world.place(body, test::random_pose(random, 0.5), {});
    }
  }

  void move() {
    ++world.motion().tick;
    for (const BodyId body : bodies) {
      if (body == World::fixed || families::count_between(random, 0, 3) == 0) continue;
      const bool leap = families::count_between(random, 0, 99) == 0;
      Pose X = world.motion().bodies[body.index].X_WB;
      X.linear() = families::small_rotation(random, leap ? 1.0 : 0.01) * X.linear();
      X.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
      X.translation() += (leap ? 0.2 : 0.003) * families::direction(random);
      X.translation() *= std::min(1.0, 0.5 / std::max(1e-9, X.translation().norm()));
      world.place(body, X, {});
    }
  }
};

inline Pose pose_of(const World& world, PartId id) {
  const Part& part = world.part(id);
  return world.motion().bodies[part.body.index].X_WB * part.X_BP;
}

/// The separation of a pair at the present motion by the measure of the world, from a cold start.
inline Separation separation_now(const World& world, const Pair& pair) {
  return separation(world.part(pair.a).shape, pose_of(world, pair.a), world.part(pair.b).shape,
                    pose_of(world, pair.b), world.query_options());
}

/// Velocity of the body-fixed point that is now at `p_WQ`.
inline Vec3 velocity_at(const World& world, BodyId body, const Vec3& p_WQ) {
  const BodyState& state = world.motion().bodies[body.index];
  return state.V_WB.linear + state.V_WB.angular.cross(p_WQ - state.X_WB.translation());
}

/// The distance of a pair by its contact patch, and its gradient, from a cold start.
struct DistanceNow {
  double distance = 0.0;  ///< [m]
  Wrench gradient;        ///< about the origin of body A
};

inline DistanceNow distance_now(const World& world, const Pair& pair) {
  const Pose X_WA = pose_of(world, pair.a);
  const Pose X_WB = pose_of(world, pair.b);
  const Separation s = separation_now(world, pair);
  ContactPatch patch;
  patch.gradient.force = s.extraction_W;
  if (pair.law.tilt > 0.0) {
    (void)find_patch(s, {world.part(pair.a).shape, X_WA}, {world.part(pair.b).shape, X_WB},
                     pair.law.tilt, patch);
  }
  const Vec3& f = patch.gradient.force;
  const BodyId a = world.part(pair.a).body;
  const Vec3 arm = s.p_WA - world.motion().bodies[a.index].X_WB.translation();
  return {s.distance - patch.nearer, {f, patch.gradient.torque + arm.cross(f)}};
}

/// The force of a pair on its body A at the present motion, about the origin of that body.
inline Wrench force_now(const World& world, const Pair& pair, bool at_rest = false) {
  const DistanceNow now = distance_now(world, pair);
  const BodyState& A = world.motion().bodies[world.part(pair.a).body.index];
  const BodyState& B = world.motion().bodies[world.part(pair.b).body.index];
  const Vec3 p_BA = A.X_WB.translation() - B.X_WB.translation();
  const Vec3 v = A.V_WB.linear - B.V_WB.linear - B.V_WB.angular.cross(p_BA);
  const Vec3 w = A.V_WB.angular - B.V_WB.angular;
  const double rate = now.gradient.force.dot(v) + now.gradient.torque.dot(w);
  return pair.law(now.distance, at_rest ? 0.0 : rate) * now.gradient;
}

/// The forces of all pairs at the present motion, each from a cold start; torques by definition.
inline std::vector<Wrench> forces_now(const World& world, bool at_rest = false) {
  std::vector<Wrench> on_body(world.body_count());
  for (const Pair& pair : world.pairs()) {
    const BodyId a = world.part(pair.a).body;
    const BodyId b = world.part(pair.b).body;
    const Wrench on_a = force_now(world, pair, at_rest);
    const Vec3 p_BA = world.motion().bodies[a.index].X_WB.translation() -
                      world.motion().bodies[b.index].X_WB.translation();
    on_body[a.index] += on_a;
    on_body[b.index] += {-on_a.force, -on_a.torque - p_BA.cross(on_a.force)};
  }
  return on_body;
}

}  // namespace repel::test
