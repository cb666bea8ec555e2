// SPDX-License-Identifier: BSD-3-Clause
#include "polytope.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <repel/geometry/facets.hpp>

namespace repel::cover {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two unit vectors that span the plane with normal n.
std::pair<Vec3, Vec3> span_of(const Vec3& n) {
  const Vec3 u = n.unitOrthogonal();
  return {u, n.cross(u)};
}

/// The polygon of points in a plane with normal n that are the corners of a convex set, in order.
Polygon in_order(const std::vector<Vec3>& points, const Vec3& n) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  const auto [u, v] = span_of(n);
  std::vector<std::pair<double, Vec3>> by_angle;
  by_angle.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 r = p - middle;
    by_angle.emplace_back(std::atan2(r.dot(v), r.dot(u)), p);
  }
  std::sort(by_angle.begin(), by_angle.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  Polygon polygon;
  for (const auto& [angle, p] : by_angle) {
    if (polygon.empty() || p != polygon.back()) polygon.push_back(p);
  }
  return polygon;
}

/// The normal and the largest distance from the first point of a set in one plane; a zero normal
/// if it is in one line.
Vec3 normal_of_flat(std::span<const Vec3> points) {
  Vec3 far = points[0];
  for (const Vec3& p : points) {
    if ((p - points[0]).squaredNorm() > (far - points[0]).squaredNorm()) far = p;
  }
  Vec3 normal = Vec3::Zero();
  for (const Vec3& p : points) {
    const Vec3 n = (far - points[0]).cross(Vec3(p - points[0]));
    if (n.squaredNorm() > normal.squaredNorm()) normal = n;
  }
  const double length = (far - points[0]).norm();
  // Thinner than 1e-9 of its length is a line.
  return normal.norm() <= 1e-9 * length * length ? Vec3(0, 0, 0) : Vec3(normal.normalized());
}

bool is_known(const std::vector<HalfSpace>& planes, const HalfSpace& plane, double reach) {
  constexpr double same = 1e-13;
  return std::any_of(planes.begin(), planes.end(), [&](const HalfSpace& known) {
    return (known.n - plane.n).squaredNorm() < same * same && known.offset >= plane.offset &&
           known.offset - plane.offset < same * reach;
  });
}

}  // namespace

Vec3 crossing(const Vec3& a, double ha, const Vec3& b, double hb) {
  const bool is_rising = ha < hb;
  const Vec3& low = is_rising ? a : b;
  const Vec3& high = is_rising ? b : a;
  const double below = std::min(ha, hb);
  return low + (below / (below - std::max(ha, hb))) * Vec3(high - low);
}

HeightRange heights(std::span<const Vec3> points, const HalfSpace& plane) {
  HeightRange range{infinity, -infinity};
  for (const Vec3& p : points) {
    const double h = plane.height(p);
    range.low = std::min(range.low, h);
    range.high = std::max(range.high, h);
  }
  return range;
}

Polygon clipped(const Polygon& polygon, const HalfSpace& plane) {
  Polygon kept;
  kept.reserve(polygon.size() + 1);
  for_each_corner(polygon, plane, [&](const Vec3& p, double height) {
    if (height <= 0.0) kept.push_back(p);
  });
  return kept;
}

Polytope Polytope::box(const Vec3& low, const Vec3& high) {
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = {(i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                  (i & 4) ? high.z() : low.z()};
  }
  constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  Polytope result;
  for (const auto& side : sides) {
    Polygon& face = result.faces_.emplace_back();
    for (const int i : side) face.push_back(corners[i]);
  }
  return result;
}

Polytope Polytope::hull(std::span<const Vec3> points) {
  Polytope result;
  for (const Facet& facet : hull_facets(points)) {
    Polygon& face = result.faces_.emplace_back();
    for (const int i : facet.vertices) face.push_back(points[i]);
  }
  return result;
}

std::vector<Vec3> Polytope::corners() const {
  std::vector<Vec3> all;
  for (const Polygon& face : faces_) all.insert(all.end(), face.begin(), face.end());
  std::sort(all.begin(), all.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Polytope Polytope::clipped(const HalfSpace& plane) const {
  Polytope result;
  std::vector<Vec3> cut;
  bool has_inside = false;
  bool has_outside = false;
  for (const Polygon& face : faces_) {
    for (const Vec3& p : face) {
      const double h = plane.height(p);
      has_inside = has_inside || h < 0.0;
      has_outside = has_outside || h > 0.0;
    }
  }
  if (!has_outside) return *this;
  if (!has_inside) return {};
  for (const Polygon& face : faces_) {
    Polygon kept = cover::clipped(face, plane);
    if (kept.size() < 2) continue;
    for_each_corner(face, plane, [&](const Vec3& p, double height) {
      if (height == 0.0) cut.push_back(p);
    });
    if (kept.size() >= 3) result.faces_.push_back(std::move(kept));
  }
  Polygon cap = in_order(cut, plane.n);
  if (cap.size() >= 3) result.faces_.push_back(std::move(cap));
  return result;
}

namespace {

bool precedes(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Sandwiches the hull of many points between that of a few of them and the planes parallel to the
/// facets of that one.
class Sandwich {
 public:
  explicit Sandwich(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    std::sort(points_.begin(), points_.end(), &precedes);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    low_ = high_ = points_[0];
    for (const Vec3& p : points_) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    for (int k = 0; k < 26; ++k) {
      const int at = k < 13 ? k : k + 1;  // all but the middle of a cube of 27
      const int layer = at / 9;
      const Vec3 n(at % 3 - 1, at / 3 % 3 - 1, layer - 1);
      inner_.push_back(*std::max_element(points_.begin(), points_.end(),
                                         [&](auto& a, auto& b) { return n.dot(a) < n.dot(b); }));
    }
  }

  /// Corners of a convex set that contains all points; none if these are in one plane.
  std::vector<Vec3> corners_around() {
    constexpr std::size_t most_inner = 160;
    constexpr int most_rounds = 8;
    const double enough = 1e-5 * Vec3(high_ - low_).norm();
    for (int round = 0;; ++round) {
      measure();
      if (sides_.empty()) return {};
      std::vector<Side> sides = sides_;
      std::sort(sides.begin(), sides.end(),
                [](const Side& a, const Side& b) { return a.gap > b.gap; });
      const std::size_t before = inner_.size();
      for (const Side& side : sides) {
        if (side.gap > enough && inner_.size() < most_inner) inner_.push_back(side.farthest);
      }
      if (inner_.size() == before || round == most_rounds) break;
    }
    const Vec3 around = Vec3::Constant(Vec3(high_ - low_).norm());
    Polytope outer = Polytope::box(low_ - around, high_ + around);
    for (const Side& side : sides_) {
      outer = outer.clipped({side.plane.n, side.plane.offset + side.gap});
    }
    return outer.corners();
  }

 private:
  struct Side {
    HalfSpace plane;   ///< of a facet of the inner hull
    double gap = 0.0;  ///< [m] how far points are above it
    Vec3 farthest{0, 0, 0};
  };

  /// The sides of the inner hull. Points inside of it no longer count.
  void measure() {
    sides_.clear();
    for (const Facet& f : hull_facets(inner_)) {
      Side& side = sides_.emplace_back();
      side.plane = {f.n, f.offset};
    }
    const auto is_inside = [&](const Vec3& p) {
      bool is_above = false;
      for (Side& side : sides_) {
        const double height = side.plane.height(p);
        is_above = is_above || height > 0.0;
        if (height <= side.gap) continue;
        side.gap = height;
        side.farthest = p;
      }
      return !is_above;
    };
    if (!sides_.empty()) std::erase_if(points_, is_inside);
  }

  std::vector<Vec3> points_;
  Vec3 low_, high_;
  std::vector<Vec3> inner_;
  std::vector<Side> sides_;
};

/// Points with the same hull; of very many points with one around it that has few corners.
std::vector<Vec3> points_for_hull(std::span<const Vec3> points) {
  constexpr std::size_t most_exact = 100'000;
  if (points.size() > most_exact) {
    std::vector<Vec3> around = Sandwich(points).corners_around();
    if (!around.empty()) return around;
  }
  return {points.begin(), points.end()};
}

}  // namespace

ConvexPart ConvexPart::of(std::span<const Vec3> points, double thickness) {
  ConvexPart part;
  if (points.empty()) return part;
  std::vector<Vec3> all = points_for_hull(points);
  std::vector<Facet> facets = hull_facets(all);
  if (facets.empty()) {
    const Vec3 n = normal_of_flat(points);
    if (n.isZero()) return part;
    all.clear();
    for (const Vec3& p : points) {
      all.push_back(p - (0.5 * thickness) * n);
      all.push_back(p + (0.5 * thickness) * n);
    }
    facets = hull_facets(all);
    if (facets.empty()) return part;
  }
  part.vertices = hull_corners(all, facets);
  part.low = part.high = part.vertices[0];
  for (const Vec3& p : part.vertices) {
    part.low = part.low.cwiseMin(p);
    part.high = part.high.cwiseMax(p);
  }
  const double reach = part.low.cwiseAbs().cwiseMax(part.high.cwiseAbs()).norm();
  for (const Facet& f : facets) {
    part.facets.push_back({all[f.vertices[0]], all[f.vertices[1]], all[f.vertices[2]]});
    const HalfSpace plane{f.n, f.offset};
    if (!is_known(part.planes, plane, reach)) part.planes.push_back(plane);
  }
  return part;
}

bool ConvexPart::contains(const Vec3& p, double margin) const {
  return !planes.empty() && std::all_of(planes.begin(), planes.end(), [&](const HalfSpace& plane) {
    return plane.height(p) <= margin;
  });
}

double ConvexPart::distance(const Vec3& p) const {
  if (planes.empty()) return infinity;
  if (contains(p, 0.0)) return 0.0;
  double least = infinity;
  for (const Polygon& f : facets) {
    least = std::min(least, (p - nearest_in_triangle(p, f[0], f[1], f[2])).squaredNorm());
  }
  return std::sqrt(least);
}

double ConvexPart::volume() const {
  double six = 0.0;
  for (const Polygon& f : facets) {
    six += Vec3(f[0] - low).dot(Vec3(f[1] - low).cross(Vec3(f[2] - low)));
  }
  return six / 6.0;
}

double largest_distance(std::span<const Vec3> points, std::span<const Vec3> triangle) {
  double largest = 0.0;
  for (const Vec3& p : points) {
    const Vec3 q = nearest_in_triangle(p, triangle[0], triangle[1], triangle[2]);
    largest = std::max(largest, (p - q).squaredNorm());
  }
  return std::sqrt(largest);
}

// By the region of the plane that p projects to: C. Ericson, Real-Time Collision Detection, 5.1.5.
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * Vec3(c - b);
  }
  const double sum = va + vb + vc;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

}  // namespace repel::cover
