// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The exact penetration depth of two small polytopes: the least overlap over all candidate
/// separating axes - the face normals and the cross products of edges (Gottschalk, Lin, Manocha
/// 1996) - ranked in double, the best recomputed with 113 bits. The proof requires that no feature
/// is missing, see Polytope::closed().
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <support/families.hpp>
#include <support/placed.hpp>
#include <support/polytope.hpp>

namespace repel::oracle {

/// The candidate axes of two posed polytopes.
class Axes {
 public:
  Axes(const Polytope& A, const Pose& X_WA, const Polytope& B, const Pose& X_WB)
      : pair_(A.vertices(), X_WA, B.vertices(), X_WB) {
    for (const Face& f : A.faces()) try_face(pair_.A, f);
    for (const Face& f : B.faces()) try_face(pair_.B, f);
    for (const auto& a : A.directions()) {
      for (const auto& b : B.directions()) try_edges(a, b);
    }
  }

  /// [m] The overlap along the best axis; not positive if an axis separates the polytopes.
  [[nodiscard]] Real least_overlap() {
    Real least = Real(1e300);
    for (const Axis& axis : axes_) {
      if (axis.overlap - axis.doubt > limit_) continue;
      const Point n = normal(axis);
      const Real length = square_root(dot(n, n));
      const Real one = (pair_.A.most(n) - pair_.B.least(n)) / length;
      const Real other = (pair_.B.most(n) - pair_.A.least(n)) / length;
      least = std::min(least, std::min(one, other));
    }
    return least;
  }

 private:
  /// n is (q - p) x (s - r), where p, q, r and s are vertices.
  struct Axis {
    double overlap = 0.0;  ///< [m] in double
    double doubt = 0.0;    ///< [m] bound of its rounding error
    Placed* first = nullptr;
    Placed* second = nullptr;
    int p = 0, q = 0, r = 0, s = 0;
  };

  void try_face(Placed& set, const Face& f) {
    consider({0, 0, &set, &set, f.corners[0], f.corners[1], f.corners[0], f.corners[2]});
  }
  void try_edges(const std::array<int, 2>& a, const std::array<int, 2>& b) {
    consider({0, 0, &pair_.A, &pair_.B, a[0], a[1], b[0], b[1]});
  }

  void consider(Axis axis) {
    const Rough e = axis.first->rough(axis.q) - axis.first->rough(axis.p);
    const Rough f = axis.second->rough(axis.s) - axis.second->rough(axis.r);
    const Rough n = cross(e, f);
    const double product = std::sqrt(dot(e, e) * dot(f, f));
    const double length = std::sqrt(dot(n, n));
    // A facet between almost parallel edges is so thin that its neighbours are decisive, too.
    if (length < 1e-14 * product) return;
    double most_a = -1e300, least_a = 1e300, most_b = -1e300, least_b = 1e300;
    range(pair_.A, n, most_a, least_a);
    range(pair_.B, n, most_b, least_b);
    axis.overlap = std::min(most_a - least_b, most_b - least_a) / length;
    axis.doubt = 1e-14 * pair_.size() * pair_.size() * std::max(1.0, product / length) /
                 std::min(pair_.size(), std::min(std::sqrt(dot(e, e)), std::sqrt(dot(f, f))));
    limit_ = std::min(limit_, axis.overlap + axis.doubt);
    axes_.push_back(axis);
  }

  static void range(const Placed& set, const Rough& n, double& most, double& least) {
    for (int i = 0; i < set.count(); ++i) {
      const double along = dot(set.rough(i), n);
      most = std::max(most, along);
      least = std::min(least, along);
    }
  }

  [[nodiscard]] static Point normal(const Axis& axis) {
    return cross(axis.first->exact(axis.q) - axis.first->exact(axis.p),
                 axis.second->exact(axis.s) - axis.second->exact(axis.r));
  }

  PlacedPair pair_;
  double limit_ = 1e300;  ///< [m] upper bound of the best overlap
  std::vector<Axis> axes_;
};

/// [m] Positive in overlap; not positive if an axis separates the polytopes. At least one must be
/// closed; the other may be flat.
inline Real penetration_depth(const Polytope& A, const Pose& X_WA, const Polytope& B,
                              const Pose& X_WB) {
  return Axes(A, X_WA, B, X_WB).least_overlap();
}

/// The same for two boxes.
inline double penetration_depth(const Vec3& half_a, const Pose& X_WA, const Vec3& half_b,
                                const Pose& X_WB) {
  return static_cast<double>(penetration_depth(Polytope(families::box(half_a).vertices), X_WA,
                                               Polytope(families::box(half_b).vertices), X_WB));
}

}  // namespace repel::oracle
