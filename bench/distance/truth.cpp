#include "truth.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <repel/geometry/facets.hpp>
#include <support/exact_depth.hpp>
#include <support/oracle.hpp>

namespace repel::bench {

namespace {

using families::Solid;
using oracle::Point;
using oracle::Real;
using LongVec3 = Eigen::Matrix<long double, 3, 1>;
using Edges = std::set<std::pair<int, int>>;

/// The vertices of a solid that may decide, not all of a thousand.
class Deciding {
 public:
  Deciding(const Solid& solid, const Pose& X_W) : solid_(solid), X_W_(X_W) {}

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }

  /// Adds the vertex farthest along n; false when it is there already.
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

std::vector<LongVec3> placed_vertices(const Solid& s, const Pose& X_W) {
  std::vector<LongVec3> placed;
  for (const Vec3& v : s.vertices) {
    placed.emplace_back(X_W.linear().cast<long double>() * v.cast<long double>() +
                        X_W.translation().cast<long double>());
  }
  return placed;
}

/// Appends the normals of the facets of `s`, whose vertices lie at `p_W`; returns its edges.
Edges add_facet_normals(const Solid& s, const std::vector<LongVec3>& p_W,
                        std::vector<LongVec3>& axes) {
  Edges edges;
  for (const Facet& f : hull_facets(s.vertices)) {
    const auto& v = f.vertices;
    axes.emplace_back((p_W[v[1]] - p_W[v[0]]).cross(p_W[v[2]] - p_W[v[0]]));
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(v[k], v[(k + 1) % 3]));
  }
  return edges;
}

/// [m] How far the vertices reach along the axis: the least and the greatest.
std::pair<long double, long double> extent(const std::vector<LongVec3>& p_W, const LongVec3& axis) {
  long double low = axis.dot(p_W[0]);
  long double high = low;
  for (const LongVec3& p : p_W) {
    low = std::min(low, axis.dot(p));
    high = std::max(high, axis.dot(p));
  }
  return {low, high};
}

}  // namespace

double exact_gap(const Solid& A, const Pose& X_WA, const Solid& B, const Pose& X_WB) {
  Deciding a(A, X_WA);
  Deciding b(B, X_WB);
  Point n{};  // from B to A
  for (int i = 0; i < 3; ++i) n.x[i] = X_WA.translation()[i] - X_WB.translation()[i];
  double distance = 0.0;
  // Ends when no vertex lies farther along the normal than those that decided: it is then proven.
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
  if (A.box && B.box) return oracle::penetration_depth(A.half_extents, X_WA, B.half_extents, X_WB);
  // Some face of A or B, or a pair of edges, is where the least overlap lies.
  const std::vector<LongVec3> a = placed_vertices(A, X_WA);
  const std::vector<LongVec3> b = placed_vertices(B, X_WB);
  std::vector<LongVec3> axes;
  const Edges edges_a = add_facet_normals(A, a, axes);
  const Edges edges_b = add_facet_normals(B, b, axes);
  for (const auto& [a0, a1] : edges_a) {
    for (const auto& [b0, b1] : edges_b) axes.emplace_back((a[a1] - a[a0]).cross(b[b1] - b[b0]));
  }
  long double least = 1e300L;
  for (const LongVec3& axis : axes) {
    const long double length = axis.norm();
    if (length < 1e-12L) continue;  // parallel edges: a face says as much
    const auto [a_low, a_high] = extent(a, axis);
    const auto [b_low, b_high] = extent(b, axis);
    least = std::min({least, (a_high - b_low) / length, (b_high - a_low) / length});
  }
  return static_cast<double>(least);
}

}  // namespace repel::bench
