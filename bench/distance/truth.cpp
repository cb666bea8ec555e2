// SPDX-License-Identifier: BSD-3-Clause
#include "truth.hpp"

#include <set>
#include <stdexcept>
#include <vector>

#include <support/exact_depth.hpp>
#include <support/oracle.hpp>

namespace repel::bench {

namespace {

using families::Solid;
using oracle::Point;
using oracle::Real;

/// Working set of vertices of a solid that determine the result, to avoid using all of a thousand.
class Deciding {
 public:
  Deciding(const Solid& solid, const Pose& X_W) : solid_(solid), X_W_(X_W) {}

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }

  /// Adds the vertex farthest along n; false if it is already included.
  bool add_farthest(const Point& n) {
    int best = 0;
    Real farthest = along(0, n);
    for (int i = 1; i < static_cast<int>(solid_.vertices.size()); ++i) {
      const Real here = along(i, n);
      if (here > farthest) {
        farthest = here;
        best = i;
      }
    }
    if (!known_.insert(best).second) return false;
    vertices_.push_back(solid_.vertices[best]);
    return true;
  }

 private:
  [[nodiscard]] Real along(int i, const Point& n) const {
    return oracle::dot(oracle::placed(X_W_, solid_.vertices[i]), n);
  }

  const Solid& solid_;
  const Pose& X_W_;
  std::set<int> known_;
  std::vector<Vec3> vertices_;
};

Point negated(const Point& p) {
  return {{-p.x[0], -p.x[1], -p.x[2]}};
}

}  // namespace

double exact_gap(const Solid& A, const Pose& X_WA, const Solid& B, const Pose& X_WB) {
  Deciding a(A, X_WA);
  Deciding b(B, X_WB);
  Point n{};  // from B to A
  for (int i = 0; i < 3; ++i) n.x[i] = X_WA.translation()[i] - X_WB.translation()[i];
  double distance = 0.0;
  // Ends when no vertex is farther along the normal than those included: this proves the result.
  while (a.add_farthest(negated(n)) | b.add_farthest(n)) {
    const auto found = oracle::distance(a.vertices(), X_WA, b.vertices(), X_WB);
    if (!found) throw std::runtime_error("the oracle could not prove a distance");
    if (!(found->distance > 0)) return 0.0;
    distance = static_cast<double>(found->distance);
    for (int i = 0; i < 3; ++i) n.x[i] = found->normal[i];
  }
  return distance;
}

double exact_depth(const Solid& A, const Pose& X_WA, const Solid& B, const Pose& X_WB) {
  const oracle::Polytope a(A.vertices);
  const oracle::Polytope b(B.vertices);
  if (!a.closed() || !b.closed()) throw std::runtime_error("a solid has no volume");
  return static_cast<double>(oracle::penetration_depth(a, X_WA, b, X_WB));
}

}  // namespace repel::bench
