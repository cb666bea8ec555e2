#include "seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "excess.hpp"

namespace repel::cover {
namespace {

/// Whether the facets of `part` in this plane are within the solid somewhere: beyond at least one
/// of their middles there is solid.
bool is_within(const ConvexPart& part, const HalfSpace& plane, const Solid& solid, double step) {
  const double flat = 1e-9 * solid.size();
  return std::any_of(part.facets.begin(), part.facets.end(), [&](const Polygon& f) {
    if (heights(f, plane).low < -flat) return false;
    const Vec3 middle = (f[0] + f[1] + f[2]) / 3.0;
    for (const Vec3& p : {middle, Vec3(0.5 * (middle + f[0])), Vec3(0.5 * (middle + f[1])),
                          Vec3(0.5 * (middle + f[2]))}) {
      if (solid.has_inside(p + step * plane.n)) return true;
    }
    return false;
  });
}

/// Corners that were computed several times, once each; those of `known` as they are there. What
/// differs by rounding alone would become edges and facets of its own.
std::vector<Vec3> distinct(const std::vector<Vec3>& corners, const std::vector<Vec3>& known,
                           double same) {
  std::vector<Vec3> points;
  const auto find = [&](const std::vector<Vec3>& list, const Vec3& p) {
    return std::find_if(list.begin(), list.end(),
                        [&](const Vec3& q) { return (p - q).squaredNorm() <= same * same; });
  };
  for (const Vec3& corner : corners) {
    const auto original = find(known, corner);
    const Vec3& p = original != known.end() ? *original : corner;
    if (find(points, p) == points.end()) points.push_back(p);
  }
  return points;
}

/// The part with its planes moved outward.
ConvexPart moved(const ConvexPart& part, const std::vector<double>& outward, double overlap,
                 double same) {
  const Vec3 reach = Vec3::Constant(overlap);
  Polytope shape = Polytope::box(part.low - reach, part.high + reach);
  for (std::size_t i = 0; i < part.planes.size(); ++i) {
    shape = shape.clipped({part.planes[i].n, part.planes[i].offset + outward[i]});
  }
  return ConvexPart::of(distinct(shape.corners(), part.vertices, same), 0.0);
}

/// The polygons of facets that lie within other parts.
std::vector<Polygon> hidden_facets(std::span<const ConvexPart> parts, double margin) {
  std::vector<Polygon> hidden;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const bool meet = Bounds{parts[i].low, parts[i].high}.meets({parts[j].low, parts[j].high});
      if (i == j || !meet) continue;
      for (const Polygon& facet : parts[i].facets) {
        Polygon piece = facet;
        for (const HalfSpace& plane : parts[j].planes) {
          // Facets that lie in each other's planes are not within.
          piece = clipped(piece, {plane.n, plane.offset - margin});
          if (piece.size() < 3) break;
        }
        if (piece.size() >= 3) hidden.push_back(std::move(piece));
      }
    }
  }
  return hidden;
}

double area_of(const Polygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += Vec3(polygon[i - 1] - polygon[0]).cross(Vec3(polygon[i] - polygon[0]));
  }
  return 0.5 * twice.norm();
}

/// Looks for points that are deep in the solid and not in any part.
class SeamSearch {
 public:
  SeamSearch(const Solid& solid, std::span<const ConvexPart> parts, double reach)
      : solid_(solid), parts_(parts), reach_(reach) {}

  double run(const std::vector<Polygon>& hidden, int samples) {
    std::vector<double> sums;
    double sum = 0.0;
    for (const Polygon& polygon : hidden) sums.push_back(sum += area_of(polygon));
    for (int i = 0; i < samples; ++i) {
      const auto drawn = std::lower_bound(sums.begin(), sums.end(), uniform() * sum);
      const auto index = std::min<std::size_t>(drawn - sums.begin(), hidden.size() - 1);
      look_at(point_of(hidden[index]) + around(reach_));
    }
    follow();
    return least_ < 1e300 ? least_ : deepest_;
  }

 private:
  double uniform() { return std::ldexp(static_cast<double>(random_() >> 11U), -53); }

  Vec3 around(double radius) {
    const auto coordinate = [&] { return radius * (2.0 * uniform() - 1.0); };
    const double x = coordinate();
    const double y = coordinate();
    return {x, y, coordinate()};
  }

  /// A point of a convex polygon: a mean of its corners.
  Vec3 point_of(const Polygon& polygon) {
    Vec3 p = Vec3::Zero();
    double total = 0.0;
    for (const Vec3& corner : polygon) {
      const double weight = -std::log(1.0 - uniform());
      p += weight * corner;
      total += weight;
    }
    return p / total;
  }

  [[nodiscard]] double depth_in_parts(const Vec3& p) const {
    double deepest = 0.0;
    for (const ConvexPart& part : parts_) {
      double depth = std::numeric_limits<double>::infinity();
      for (const HalfSpace& plane : part.planes) depth = std::min(depth, -plane.height(p));
      if (!part.planes.empty()) deepest = std::max(deepest, depth);
    }
    return deepest;
  }

  /// Whether p is less deep in every part than the least before, and twice as deep in the solid.
  bool look_at(const Vec3& p) {
    const double felt = depth_in_parts(p);
    const double depth = solid_.surface().nearest(p).distance;
    if (depth <= deepest_ && (depth <= 2.0 * felt || felt >= least_)) return false;
    if (!solid_.has_inside(p)) return false;
    deepest_ = std::max(deepest_, depth);
    if (depth <= 2.0 * felt || felt >= least_) return false;
    least_ = felt;
    at_ = p;
    return true;
  }

  /// Goes on from the least point in smaller and smaller steps.
  void follow() {
    if (least_ == 1e300) return;
    constexpr int steps = 200;
    for (double radius = reach_; radius > 1e-3 * reach_; radius *= 0.5) {
      for (int i = 0; i < steps; ++i) look_at(at_ + around(radius));
    }
  }

  const Solid& solid_;
  std::span<const ConvexPart> parts_;
  double reach_;
  double least_ = 1e300;
  double deepest_ = 0.0;
  Vec3 at_{0, 0, 0};
  std::mt19937_64 random_{1};
};

}  // namespace

ConvexPart grown(const ConvexPart& part, const Solid& solid, double overlap, double error) {
  if (!(overlap > 0.0) || part.planes.empty()) return part;
  std::vector<double> outward(part.planes.size(), 0.0);
  const double step = std::min(0.1 * overlap, 1e-4 * solid.size());
  for (std::size_t i = 0; i < outward.size(); ++i) {
    if (is_within(part, part.planes[i], solid, step)) outward[i] = overlap;
  }
  const ExcessOptions coarse{.gap = 0.1 * error, .most_pieces = 20'000};
  const double allowed = std::max(error, excess_of(part, solid, coarse).bound);
  constexpr int most_tries = 40;
  for (int i = 0; i < most_tries; ++i) {
    ConvexPart next = moved(part, outward, overlap, 1e-10 * solid.size());
    ExcessOptions options = coarse;
    options.enough = allowed;
    const Excess excess = excess_of(next, solid, options);
    if (excess.bound <= allowed) return next;
    // The planes that keep out what reaches too far: they move half as far. All of them if the
    // search found none.
    bool has_changed = false;
    for (std::size_t k = 0; k < outward.size(); ++k) {
      if (outward[k] == 0.0) continue;
      if (excess.reached > allowed && part.planes[k].height(excess.at) <= 1e-3 * outward[k])
        continue;
      outward[k] = outward[k] < 0.05 * overlap ? 0.0 : 0.5 * outward[k];
      has_changed = true;
    }
    if (!has_changed) break;
  }
  return part;
}

std::optional<double> seam_depth(const Solid& solid, std::span<const ConvexPart> parts,
                                 double overlap, int samples) {
  const std::vector<Polygon> hidden = hidden_facets(parts, 1e-7 * solid.size());
  if (hidden.empty()) return std::nullopt;
  const double reach = 2.0 * std::max(overlap, 1e-3 * solid.size());
  return SeamSearch(solid, parts, reach).run(hidden, samples);
}

}  // namespace repel::cover
