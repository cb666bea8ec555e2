// SPDX-License-Identifier: BSD-3-Clause
#include <ccd/ccd.h>

#include <cmath>

#include "rival.hpp"

namespace repel::bench {

namespace {

/// The argument of libccd's callbacks: the user's shape at its pose.
struct Body {
  const Solid* solid = nullptr;
  Pose X_W = Pose::Identity();
  Vec3 centre = Vec3::Zero();
};

ccd_vec3_t to_ccd(const Vec3& v) {
  return {{v.x(), v.y(), v.z()}};
}

/// The support map, which libccd leaves to the user: signs for a box, a linear scan for a hull.
void support(const void* object, const ccd_vec3_t* direction_W, ccd_vec3_t* farthest_W) {
  const Body& body = *static_cast<const Body*>(object);
  const Vec3 d =
      body.X_W.linear().transpose() * Vec3(direction_W->v[0], direction_W->v[1], direction_W->v[2]);
  Vec3 best = body.solid->vertices[0];
  if (body.solid->box) {
    for (int k = 0; k < 3; ++k) best[k] = std::copysign(body.solid->half_extents[k], d[k]);
  } else {
    double most = best.dot(d);
    for (const Vec3& v : body.solid->vertices) {
      const double here = v.dot(d);
      if (here > most) {
        most = here;
        best = v;
      }
    }
  }
  *farthest_W = to_ccd(body.X_W * best);
}

/// An interior point, from which MPR starts.
void place_centre(const void* object, ccd_vec3_t* centre_W) {
  const Body& body = *static_cast<const Body*>(object);
  *centre_W = to_ccd(body.X_W * body.centre);
}

using Method = int (*)(const void*, const void*, const ccd_t*, ccd_real_t* depth, ccd_vec3_t* dir,
                       ccd_vec3_t* pos);

template <Method penetration>
class Libccd {
 public:
  struct Result {
    int apart;  ///< 0 in overlap
    double depth;
    ccd_vec3_t direction_W, p_W;
  };

  Libccd(const Task& task, double tolerance) : task_(task) {
    CCD_INIT(&ccd_);
    ccd_.support1 = ccd_.support2 = support;
    ccd_.max_iterations = 1000;
    ccd_.epa_tolerance = tolerance;
    ccd_.mpr_tolerance = tolerance;
    ccd_.center1 = ccd_.center2 = place_centre;
    std::vector<Vec3> centres;
    for (const Solid& s : task.solids) centres.push_back(centre(s));
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = bodies_.emplace_back();
      for (std::size_t i = 0; i < X_W.size(); ++i) {
        placed.push_back({&task.solids[i], X_W[i], centres[i]});
      }
    }
  }

  Result cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    const std::vector<Body>& bodies = bodies_[ask.tick];
    Result r{};
    r.apart = penetration(&bodies[a], &bodies[b], &ccd_, &r.depth, &r.direction_W, &r.p_W);
    return r;
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    if (r.apart != 0) return {.distance = std::nan("")};
    const ccd_real_t* out_of_a = r.direction_W.v;  // the direction in which B separates from A
    return {.distance = -r.depth, .extraction_W = -Vec3(out_of_a[0], out_of_a[1], out_of_a[2])};
  }

 private:
  const Task& task_;
  ccd_t ccd_{};
  std::vector<std::vector<Body>> bodies_;
};

const Enlisted enlisted({
    .name = "libccd",
    .version = "2.1",
    .settings = "ccdGJKPenetration in double, support maps of our own writing, the loosest "
                "tolerance that is right; it has no distance of pairs that are apart and keeps "
                "nothing from tick to tick",
    .tolerance = 1e-8,
    .sweeps = false,
    .warms = false,
    .gaps = false,
    .load = Adapter<Libccd<ccdGJKPenetration>>::load,
});

const Enlisted with_portals({
    .name = "libccd_mpr",
    .version = "2.1",
    .settings = "ccdMPRPenetration, set as libccd; fast, and not meant to be exact",
    .tolerance = 1e-8,
    .sweeps = false,
    .warms = false,
    .gaps = false,
    .exact_depths = false,
    .load = Adapter<Libccd<ccdMPRPenetration>>::load,
});

}  // namespace

}  // namespace repel::bench
