// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A finger right through a body that may be entered, slowly and straight down.
#pragma once

#include <algorithm>
#include <vector>

#include <repel/force/passage.hpp>

namespace repel::figures {

struct Crossing {
  const char* name;
  Shape body;
  ForceLaw law;
  double aside = 0.0;  ///< [m] of the finger along x from the middle of the body
};

/// A membrane of 4 mm, tissue of 100 mm, and the same tissue with the finger half over its edge.
inline std::vector<Crossing> crossings() {
  const Shape plate = Shape::box({0.08, 0.1, 0.002});
  const Shape block = Shape::box({0.08, 0.1, 0.05});
  const ForceLaw membrane{.range = 0.015, .surface_force = 60.0, .ceiling = 12.0};
  const ForceLaw tissue{.range = 0.015, .surface_force = 20.0, .ceiling = 5.0};
  return {{"membrane", plate, membrane},
          {"tissue", block, tissue},
          {"edge of the tissue", block, tissue, 0.08}};
}

struct CrossingForce {
  double height = 0.0;  ///< [m] of the middle of the finger above that of the body
  Vec3 f_W{0, 0, 0};    ///< [N] on the finger
};

/// The force at equal steps from above to below.
inline std::vector<CrossingForce> forces_along(const Crossing& crossing, bool passable) {
  constexpr double reach = 0.12;  // [m] above and below
  constexpr int steps = 4800;
  const Shape finger = Shape::box({0.012, 0.012, 0.03});
  ForceLaw law = crossing.law;
  law.passable = passable;
  law.depth = finger.deepest() + crossing.body.deepest();
  const Pose X_WB = Pose::Identity();
  Pose X_WA = Pose::Identity();
  Passage passage;
  WarmStart warm;
  std::vector<CrossingForce> forces;
  for (int i = 0; i <= steps; ++i) {
    const double way = 2.0 * reach * i / steps;
    X_WA.translation() = Vec3(crossing.aside, 0.0, reach - way);
    const Separation s = separation(finger, X_WA, crossing.body, X_WB, {}, warm);
    int iterations = 0;
    const double slope = slope_of(s, {finger, X_WA}, {crossing.body, X_WB}, {}, warm, iterations);
    const Vec3 f_W = passable
                         ? passage.force(law, s.distance, slope * s.extraction_W, way, Vec3::Zero())
                         : Vec3(law(s.distance, 0.0) * s.extraction_W);
    forces.push_back({reach - way, f_W});
  }
  return forces;
}

}  // namespace repel::figures
