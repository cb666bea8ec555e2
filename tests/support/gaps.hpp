// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pairs with a chosen gap, and the distance of the core next to the exact one.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <repel/distance/gjk.hpp>
#include <support/families.hpp>
#include <support/oracle.hpp>

namespace repel::families {

inline Convex convex(const Solid& s) {
  return s.box ? Convex::box(s.half_extents) : Convex::polytope(s.vertices);
}

inline std::optional<oracle::Truth> truth(const Pair& p) {
  return oracle::distance(p.A.vertices, p.X_WA, p.B.vertices, p.X_WB);
}

/// [m] Scale of absolute errors: the larger size of the two.
inline double size(const Pair& p) {
  double largest = 0.0;
  for (const Vec3& v : p.A.vertices) largest = std::max(largest, v.norm());
  for (const Vec3& v : p.B.vertices) largest = std::max(largest, v.norm());
  return largest;
}

/// The same pair with B moved along `n` by `step` [m].
inline Pair shifted(Pair p, const double (&n)[3], double step) {
  for (int i = 0; i < 3; ++i) p.X_WB.translation()[i] += step * n[i];
  return p;
}

/// Moves B along the normal until the gap of the pair is `gap` [m], as closely as the doubles of a
/// pose allow; negative means overlap. Nothing if the pair of the family overlaps.
inline std::optional<Pair> apart_by(const Pair& p, double gap) {
  const auto found = truth(p);
  if (!found || !(found->distance > 0)) return std::nullopt;
  return shifted(p, found->normal, static_cast<double>(found->distance) - gap);
}

/// A seeded pair of the family, `gap` [m] apart.
inline Pair draw_apart(const std::string& family, Rng& rng, double gap) {
  while (true) {
    if (const auto p = apart_by(draw(family, rng), gap)) return *p;
  }
}

/// A seeded pair of the family, at most `depth` [m] deep. Their ends are pushed into each other; if
/// thin, they may come out on the other side, in which case the draw is repeated.
inline Pair draw_overlapping(const std::string& family, Rng& rng, double depth) {
  while (true) {
    const Pair p = draw_apart(family, rng, -depth);
    const auto found = truth(p);
    if (found && !(found->distance > 0)) return p;
  }
}

/// The motion of a tool in one tick: 0.5 mm and 0.1 degree.
inline Pose moved_a_little(const Pose& X, Rng& rng) {
  Pose moved = X;
  moved.translation() += 5e-4 * direction(rng);
  moved.linear() = small_rotation(rng, 0.1 * M_PI / 180.0) * X.linear();
  return moved;
}

inline Gap measure(const Pair& p, WarmStart& warm, const QueryOptions& options = {}) {
  const Convex A = convex(p.A);
  const Convex B = convex(p.B);
  return gap_between(A, p.X_WA, B, p.X_WB, options, warm);
}
inline Gap measure(const Pair& p, const QueryOptions& options = {}) {
  WarmStart cold;
  return measure(p, cold, options);
}

}  // namespace repel::families
