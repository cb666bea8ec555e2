// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Close pairs whose nearest features are known, and a small motion of their bodies.
#pragma once

#include <repel/pairs/lane_group.hpp>

#include <vector>

#include "pairs/boxes.hpp"

namespace repel::test {

/// A box, a hull, a sphere or a capsule: the shapes supported in lanes.
inline Shape angular_shape(families::Rng& random) {
  for (;;) {
    const Shape shape = random_shape(random);
    if (shape.level(0).core.is_polytope()) return shape;
  }
}

/// Pairs with a gap of 0.5 to 30 mm, on moving and rotating bodies.
struct NearPairs {
  World world;
  families::Rng random;
  std::vector<BodyId> bodies{World::fixed};
  std::vector<WarmStart> warm;  ///< by PairId

  NearPairs(int moving, unsigned seed, Measure measure = QueryOptions{}.measure)
      : world({}, measure), random(seed) {
    for (int i = 0; i < moving; ++i) {
      bodies.push_back(world.add_body("body", random_pose(random, 0.5)));
    }
  }

  /// Adds a pair of parts of those two bodies.
  PairId add(BodyId a, BodyId b, Shape (*draw)(families::Rng&) = angular_shape) {
    const Shape A = draw(random);
    const Shape B = draw(random);
    const Pose X_WA = random_pose(random, 0.3);
    for (;;) {
      Pose X_WB = random_pose(random, 0.0);
      X_WB.translation() = X_WA.translation() + families::uniform(random, 0.3, 1.3) *
                                                    (A.reach() + B.reach()) *
                                                    families::direction(random);
      WarmStart found;
      const double gap = separation(A, X_WA, B, X_WB, {}, found).distance;
      if (gap < 0.0005 || gap > 0.03) continue;
      const auto in = [&](BodyId id) { return world.motion().bodies[id.index].X_WB.inverse(); };
      warm.push_back(found);
      return world.add_pair(world.add_part(a, "a", A, in(a)*X_WA),
                            world.add_part(b, "b", B, in(b)*X_WB),
                            {.range = families::uniform(random, 0.01, 0.03)});
    }
  }
  /// Two different random bodies.
  PairId add(Shape (*draw)(families::Rng&) = angular_shape) {
    const auto pick = [&] {
      const auto last = static_cast<int>(bodies.size()) - 1;
      return bodies[static_cast<std::size_t>(families::count_between(random, 0, last))];
    };
    const BodyId a = pick();
    BodyId b = pick();
    while (b == a) b = pick();
    return add(a, b, draw);
  }

  /// Rotates every body by up to `angle` [rad] and moves it by up to `length` [m], with random
  /// velocities.
  void move(double length, double angle) {
    ++world.motion().tick;
    for (const BodyId body : bodies) {
      if (body == World::fixed) continue;
      Pose X = world.motion().bodies[body.index].X_WB;
      X.linear() =
          families::small_rotation(random, families::uniform(random, 0.0, angle)) * X.linear();
      X.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
      X.translation() += families::uniform(random, 0.0, length) * families::direction(random);
      world.place(body, X,
                  {families::uniform(random, 0.0, 0.5) * families::direction(random),
                   families::uniform(random, 0.0, 1.0) * families::direction(random)});
    }
  }

  /// Assigns a lane to a pair.
  void set(detail::LaneGroup& group, int k, PairId id, const detail::PartPoses& poses,
           bool used = true) const {
    group.set(world, k, world.pair(id), {.warm = warm[static_cast<std::size_t>(id.index)]}, poses,
              used);
  }
};

}  // namespace repel::test
