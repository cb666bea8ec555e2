// SPDX-License-Identifier: BSD-3-Clause
#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "rival.hpp"

namespace repel::bench {

namespace {

/// The planes, points and polygons referenced by a convex geom of ODE, relative to an interior
/// point, in the format of ODE.
struct Mesh {
  Vec3 origin;
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;

  explicit Mesh(const Solid& s) : origin(centre(s)) {
    for (const Vec3& v : s.vertices) {
      const Vec3 p = v - origin;
      points.insert(points.end(), p.data(), p.data() + 3);
    }
    if (s.box) return;
    for (const auto& [i, j, k] : triangles(s)) {
      const Vec3& v = s.vertices[i];
      const Vec3 n = (s.vertices[j] - v).cross(s.vertices[k] - v).normalized();
      planes.insert(planes.end(), {n.x(), n.y(), n.z(), n.dot(v - origin)});
      polygons.insert(polygons.end(), {3U, unsigned(i), unsigned(j), unsigned(k)});
    }
  }
};

class Ode {
 public:
  static constexpr int most_contacts = 16;
  struct Result {
    int count = 0;
    std::array<dContactGeom, most_contacts> contacts{};
  };

  Ode(const Task& task, double) : task_(task) {
    static const int started = dInitODE2(0);
    (void)started;
    meshes_.reserve(task.solids.size());
    for (const Solid& s : task.solids) meshes_.emplace_back(s);
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = geoms_.emplace_back();
      for (std::size_t i = 0; i < X_W.size(); ++i) placed.push_back(geom(i, X_W[i]));
    }
  }

  Result cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    Result r;
    r.count = dCollide(geoms_[ask.tick][a].get(), geoms_[ask.tick][b].get(), most_contacts,
                       r.contacts.data(), sizeof(dContactGeom));
    return r;
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    if (r.count == 0) return {.distance = std::nan("")};
    const auto* deepest =
        std::max_element(r.contacts.begin(), r.contacts.begin() + r.count,
                         [](const auto& a, const auto& b) { return a.depth < b.depth; });
    const dReal* n = deepest->normal;  // points into the first geom
    return {.distance = -deepest->depth, .extraction_W = {n[0], n[1], n[2]}};
  }

 private:
  using Geom = std::unique_ptr<dxGeom, void (*)(dxGeom*)>;

  static unsigned count(const std::vector<dReal>& numbers, unsigned each) {
    return static_cast<unsigned>(numbers.size()) / each;
  }

  Geom geom(std::size_t i, const Pose& X) {
    const Solid& s = task_.solids[i];
    const Mesh& mesh = meshes_[i];
    const Vec3 sides = 2.0 * s.half_extents;
    Geom made(s.box
                  ? dCreateBox(nullptr, sides.x(), sides.y(), sides.z())
                  : dCreateConvex(nullptr, mesh.planes.data(), count(mesh.planes, 4),
                                  mesh.points.data(), count(mesh.points, 3), mesh.polygons.data()),
              dGeomDestroy);
    dMatrix3 R{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) R[4 * row + column] = X.linear()(row, column);
    }
    dGeomSetRotation(made.get(), R);
    const Vec3 p = X * (s.box ? Vec3::Zero() : mesh.origin);
    dGeomSetPosition(made.get(), p.x(), p.y(), p.z());
    return made;
  }

  const Task& task_;
  std::vector<Mesh> meshes_;
  std::vector<std::vector<Geom>> geoms_;
};

const Enlisted enlisted({
    .name = "ode",
    .version = "0.16.2 double",
    .settings = "dCollide on box and convex geoms, deepest contact; it has no distance of pairs "
                "that are apart, no tolerance, and keeps nothing from tick to tick",
    .tolerance = 0.0,
    .sweeps = false,
    .warms = false,
    .gaps = false,
    .load = Adapter<Ode>::load,
});

}  // namespace

}  // namespace repel::bench
