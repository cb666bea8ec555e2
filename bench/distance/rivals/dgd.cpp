// SPDX-License-Identifier: BSD-3-Clause
#include <dgd/geometry/3d/cuboid.h>
#include <dgd/geometry/3d/mesh.h>
#include <dgd/geometry/3d/polytope.h>
#include <dgd/solvers/minimum_distance_impl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

#include "rival.hpp"

namespace repel::bench {

namespace {

static_assert(std::is_same_v<dgd::Real, double>, "dgd is measured in double");

/// A solid in the types of dgd. Their origin is the centre of growth and must be inside.
struct Body {
  Vec3 origin = Vec3::Zero();
  std::unique_ptr<const dgd::Cuboid> box;  ///< either this
  std::unique_ptr<const dgd::Mesh> hull;   ///< or this

  explicit Body(const Solid& s) {
    if (s.box) {
      const Vec3& h = s.half_extents;
      box = std::make_unique<const dgd::Cuboid>(h.x(), h.y(), h.z());
      return;
    }
    origin = centre(s);
    const auto faces = triangles(s);
    std::vector<Vec3> vertices;
    for (const Vec3& v : s.vertices) vertices.push_back(v - origin);
    double inradius = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k] : faces) {
      const Vec3& v = vertices[i];
      inradius = std::min(inradius, (vertices[j] - v).cross(vertices[k] - v).normalized().dot(v));
    }
    hull =
        std::make_unique<const dgd::Mesh>(vertices, neighbours(vertices.size(), faces), inradius);
  }

 private:
  /// The graph of a mesh as dgd reads it: the numbers of vertices and faces, where the neighbours
  /// of each vertex begin, and the neighbours, with -1 after those of each vertex.
  static std::vector<int> neighbours(std::size_t vertices,
                                     const std::vector<std::array<int, 3>>& faces) {
    std::vector<std::set<int>> beside(vertices);
    for (const auto& face : faces) {
      for (int i = 0; i < 3; ++i) beside[face[i]].insert({face[(i + 1) % 3], face[(i + 2) % 3]});
    }
    std::vector<int> graph{static_cast<int>(vertices), static_cast<int>(faces.size())};
    std::vector<int> records;
    for (const std::set<int>& of_vertex : beside) {
      graph.push_back(static_cast<int>(records.size()));
      records.insert(records.end(), of_vertex.begin(), of_vertex.end());
      records.push_back(-1);
    }
    graph.insert(graph.end(), records.begin(), records.end());
    return graph;
  }
};

/// dgd computes by what factor two solids must grow to touch, which is not a distance. Its distance
/// is found by bisection: the margin around A with which this factor is 1.
class Dgd {
 public:
  using Result = dgd::DistanceOutput<3>;

  Dgd(const Task& task, double tolerance) : task_(task), tolerance_(tolerance) {
    settings_.rel_tol = 1.0 + tolerance;
    for (const Solid& s : task.solids) bodies_.emplace_back(s);
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = X_W_.emplace_back();
      for (std::size_t i = 0; i < X_W.size(); ++i) {
        placed.push_back((X_W[i] * Eigen::Translation3d(bodies_[i].origin)).matrix());
      }
    }
  }

  Result cold(const Ask& ask) {
    const auto& [ia, ib] = task_.pairs[ask.pair];
    const Body& a = bodies_[ia];
    const Body& b = bodies_[ib];
    const auto& X_W = X_W_[ask.tick];
    if (a.box && b.box) return query(*a.box, X_W[ia], *b.box, X_W[ib]);
    if (a.box) return query(*a.box, X_W[ia], *b.hull, X_W[ib]);
    if (b.box) return query(*a.hull, X_W[ia], *b.box, X_W[ib]);
    return query(*a.hull, X_W[ia], *b.hull, X_W[ib]);
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    if (r.status != dgd::SolutionStatus::Optimal) return {.distance = std::nan("")};
    return {.distance = r.min_dist, .extraction_W = -r.normal.normalized()};
  }

 private:
  template <class A, class B>
  Result query(const A& a, const dgd::Transform3r& X_WA, const B& b, const dgd::Transform3r& X_WB) {
    Result r;
    dgd::MinimumDistanceTpl(&a, X_WA, &b, X_WB, settings_, r, tolerance_);
    return r;
  }

  const Task& task_;
  double tolerance_;
  dgd::Settings settings_;
  std::vector<Body> bodies_;
  std::vector<std::vector<dgd::Transform3r>> X_W_;
};

const Enlisted enlisted({
    .name = "dgd",
    .version = REPEL_RIVAL_VERSION,
    .settings = "MinimumDistanceTpl, a bisection over growth distances, brute force by its own "
                "account; Cuboid, and Mesh with neighbours: faster than Polytope; 1e-11, also of "
                "the growth distance, is right more often than 1e-10 and 1e-12; it has no depths, "
                "and only growth distances start warm",
    .tolerance = 1e-11,
    .warms = false,
    .depths = false,
    .load = Adapter<Dgd>::load,
});

}  // namespace

}  // namespace repel::bench
