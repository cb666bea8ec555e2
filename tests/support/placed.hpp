// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two sets of vertices in world axes, relative to the origin of the first: in double, and with 113
/// bits on demand.
#pragma once

#include <algorithm>
#include <vector>

#include <support/quad.hpp>

namespace repel::oracle {

/// Vertices under a pose. The double coordinates are accurate to 1e-15 of `reach`.
class Placed {
 public:
  Placed(const std::vector<Vec3>& vertices, const Pose& X, const Point& offset)
      : vertices_(vertices),
        X_(X),
        offset_(offset),
        exact_(vertices.size()),
        is_exact_(vertices.size(), false) {
    const Rough shift = oracle::rough(offset);
    const Mat3 R = X.linear();
    const Vec3 p(shift.x[0], shift.x[1], shift.x[2]);
    for (const Vec3& v : vertices) {
      rough_.push_back(oracle::rough(Vec3(R * v + p)));
      reach_ = std::max(reach_, v.norm() + p.norm());
    }
  }

  [[nodiscard]] int count() const { return static_cast<int>(vertices_.size()); }
  [[nodiscard]] double reach() const { return reach_; }  ///< [m]
  [[nodiscard]] const Rough& rough(int i) const { return rough_[i]; }

  /// R v + p, exact for the given doubles.
  [[nodiscard]] const Point& exact(int i) {
    if (!is_exact_[i]) {
      exact_[i] = rotated(X_, oracle::exact(vertices_[i])) + offset_;
      is_exact_[i] = true;
    }
    return exact_[i];
  }

  /// The least dot product of `d` with a vertex, to 113 bits: only candidates within double
  /// rounding of the least are recomputed.
  [[nodiscard]] Real least(const Point& d) { return product(farthest(Real(-1) * d), d); }
  [[nodiscard]] Real most(const Point& d) { return product(farthest(d), d); }

  /// The vertex farthest along `d`.
  [[nodiscard]] int farthest(const Point& d) {
    const Rough along = oracle::rough(d);
    double largest = -1e300;
    for (const Rough& v : rough_) largest = std::max(largest, dot(v, along));
    const double doubt = 1e-14 * reach_ * std::sqrt(dot(along, along));
    int best = -1;
    for (int i = 0; i < count(); ++i) {
      if (dot(rough_[i], along) < largest - doubt) continue;
      if (best < 0 || product(i, d) > product(best, d)) best = i;
    }
    return best;
  }

 private:
  [[nodiscard]] Real product(int i, const Point& d) { return dot(exact(i), d); }

  const std::vector<Vec3>& vertices_;
  const Pose& X_;
  Point offset_;
  std::vector<Rough> rough_;
  std::vector<Point> exact_;
  std::vector<bool> is_exact_;
  double reach_ = 0.0;
};

/// A and B relative to the origin of A.
struct PlacedPair {
  Placed A, B;

  PlacedPair(const std::vector<Vec3>& a, const Pose& X_WA, const std::vector<Vec3>& b,
             const Pose& X_WB)
      : A(a, X_WA, Point{}), B(b, X_WB, exact(X_WB.translation()) - exact(X_WA.translation())) {}

  [[nodiscard]] double size() const { return A.reach() + B.reach(); }  ///< [m]
  /// The point of A - B with the least dot product with `x`.
  [[nodiscard]] Point support(const Point& x) {
    return A.exact(A.farthest(Real(-1) * x)) - B.exact(B.farthest(x));
  }
};

}  // namespace repel::oracle
