// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two shapes at their poses, and invariants of their signed distance along a path.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <repel/reduction/separation.hpp>
#include <support/families.hpp>

namespace repel::test {

struct PosedShapes {
  Shape A, B;
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();

  [[nodiscard]] Separation separate(WarmStart& warm) const {
    return separation(A, X_WA, B, X_WB, {}, warm);
  }
  [[nodiscard]] Separation separate() const { return separation(A, X_WA, B, X_WB); }
  [[nodiscard]] double size() const { return A.reach() + B.reach(); }
};

/// Change of the distance when A moves by `h` [m] in both directions along each axis, per metre.
struct Quotients {
  Vec3 forward, backward;
};

inline Quotients difference_quotients(PosedShapes pair, double h) {
  const double here = pair.separate().distance;
  const Vec3 p = pair.X_WA.translation();
  Quotients q;
  for (int axis = 0; axis < 3; ++axis) {
    pair.X_WA.translation() = p + h * Vec3::Unit(axis);
    q.forward[axis] = (pair.separate().distance - here) / h;
    pair.X_WA.translation() = p - h * Vec3::Unit(axis);
    q.backward[axis] = (here - pair.separate().distance) / h;
  }
  return q;
}

/// Number of sweep steps that ended in overlap, that did not, and of unfinished answers.
struct Steps {
  int inside = 0;
  int outside = 0;
  int cut_short = 0;
};

/// Moves A past or through B, over about the size of both. Checks: warm equals cold, the distance
/// changes no faster than A moves, and over three overlapping steps in a row it is convex, all to
/// `error` [m].
inline void expect_smooth_sweep(PosedShapes pair, families::Rng& rng, double error, Steps& seen) {
  const Vec3 along = families::direction(rng);
  const Vec3 aside = 0.25 * pair.size() * families::direction(rng);
  const double length = 2.2 * pair.size();
  constexpr int steps = 200;
  std::array<double, 2> before{};
  WarmStart warm;
  for (int k = 0; k <= steps; ++k) {
    pair.X_WA.translation() =
        pair.X_WB.translation() + aside + (static_cast<double>(k) / steps - 0.5) * length * along;
    const Separation s = pair.separate(warm);
    const Separation cold = pair.separate();
    for (const Separation& each : {s, cold}) {
      seen.cut_short += each.end == QueryEnd::budget_spent ? 1 : 0;
    }
    EXPECT_NEAR(s.distance, cold.distance, error) << k;
    EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-12) << k;
    EXPECT_LE(s.lower, s.distance) << k;
    EXPECT_GE(s.upper, s.distance) << k;
    if (k > 0) {
      EXPECT_LE(std::abs(s.distance - before[0]), length / steps + error) << k;
    }
    if (k > 1 && std::max({before[0], before[1], s.distance}) < 0.0) {
      EXPECT_LE(before[0], 0.5 * (before[1] + s.distance) + error) << k;
    }
    before = {s.distance, before[0]};
    ++(s.distance < 0.0 ? seen.inside : seen.outside);
  }
}

}  // namespace repel::test
