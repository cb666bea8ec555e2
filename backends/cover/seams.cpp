// SPDX-License-Identifier: BSD-3-Clause
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

/// A plane of a part, and how far it is to move outward [m].
struct Side {
  HalfSpace plane;
  double outward = 0.0;
};

Vec3 normal_of(const Polygon& triangle) {
  return Vec3(triangle[1] - triangle[0]).cross(Vec3(triangle[2] - triangle[0]));
}

/// The planes of a part, less what is there by rounding alone: facets that are narrower than `flat`
/// [m] are left out, and of facets that are in one plane within that, the largest counts. All of
/// the part stays inside.
std::vector<Side> sides_of(const ConvexPart& part, double flat) {
  constexpr double same_direction = 1e-8;
  std::vector<std::pair<double, Vec3>> by_area;
  for (const Polygon& f : part.facets) {
    const Vec3 n = normal_of(f);
    const double longest =
        std::sqrt(std::max({Vec3(f[1] - f[0]).squaredNorm(), Vec3(f[2] - f[1]).squaredNorm(),
                            Vec3(f[0] - f[2]).squaredNorm()}));
    if (n.norm() > flat * longest) by_area.emplace_back(n.norm(), n.normalized());
  }
  std::sort(by_area.begin(), by_area.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Side> sides;
  for (const auto& entry : by_area) {
    const Vec3& n = entry.second;
    const HalfSpace plane{n, heights(part.vertices, {n, 0.0}).high};
    const bool is_known = std::any_of(sides.begin(), sides.end(), [&](const Side& side) {
      return side.plane.n.dot(n) > 1.0 - same_direction &&
             std::abs(side.plane.offset - plane.offset) < flat;
    });
    if (!is_known) sides.push_back({plane, 0.0});
  }
  return sides;
}

/// Whether the facets of `part` in this plane are within the solid somewhere: beyond at least one
/// of their middles there is solid.
bool is_within(const ConvexPart& part, const HalfSpace& plane, const Solid& solid, double step) {
  const double flat = 1e-6 * solid.size();
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

/// The part with its sides moved outward.
ConvexPart moved(const ConvexPart& part, const std::vector<Side>& sides, double overlap,
                 double same) {
  const Vec3 reach = Vec3::Constant(overlap);
  Polytope shape = Polytope::box(part.low - reach, part.high + reach);
  for (const Side& side : sides) {
    shape = shape.clipped({side.plane.n, side.plane.offset + side.outward});
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
    sums.reserve(hidden.size());
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

/// Halves the way of the side that would keep out most of what reaches too far; of all sides if the
/// search found no such point. A way shorter than `least` [m] becomes none. Returns whether there
/// was a side to pull back.
bool pull_back(const Excess& excess, double allowed, double least, std::vector<Side>& sides) {
  const auto halve = [&](Side& side) {
    side.outward = side.outward < least ? 0.0 : 0.5 * side.outward;
  };
  Side* first = nullptr;
  bool has_changed = false;
  for (Side& side : sides) {
    if (side.outward == 0.0) continue;
    if (excess.reached <= allowed) {
      halve(side);
      has_changed = true;
      continue;
    }
    const double height = side.plane.height(excess.at);
    if (height <= 1e-3 * side.outward) continue;
    if (first == nullptr || height > first->plane.height(excess.at)) first = &side;
  }
  if (first == nullptr) return has_changed;
  halve(*first);
  return true;
}

}  // namespace

ConvexPart grown(const ConvexPart& part, const Solid& solid, double overlap, double error) {
  if (!(overlap > 0.0) || part.planes.empty()) return part;
  std::vector<Side> sides = sides_of(part, 1e-6 * solid.size());
  const double step = std::min(0.1 * overlap, 1e-4 * solid.size());
  for (Side& side : sides) {
    if (is_within(part, side.plane, solid, step)) side.outward = overlap;
  }
  const ExcessOptions coarse{.gap = 0.1 * error, .most_pieces = 20'000};
  const double allowed = std::max(error, excess_of(part, solid, coarse).bound);
  constexpr int most_tries = 200;
  for (int i = 0; i < most_tries; ++i) {
    ConvexPart next = moved(part, sides, overlap, 1e-10 * solid.size());
    ExcessOptions options = coarse;
    options.enough = allowed;
    const Excess excess = excess_of(next, solid, options);
    if (excess.bound <= allowed) return next;
    if (!pull_back(excess, allowed, 0.05 * overlap, sides)) break;
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
