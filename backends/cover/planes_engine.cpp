// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "coverage.hpp"
#include "engines.hpp"
#include "excess.hpp"

namespace repel::cover {
namespace {

/// A part of the surface, and the convex cell that it was cut out by.
struct Region {
  std::vector<Polygon> polygons;
  Polytope cell;
  ConvexPart hull;
  Excess excess;
  bool is_final = false;  ///< no plane divides it
};

Vec3 area_vector(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += 0.5 * Vec3(polygon[i - 1] - polygon[0]).cross(Vec3(polygon[i] - polygon[0]));
  }
  return sum;
}

/// Appends what of a polygon is below a plane, and what is above, as corners. What lies in the
/// plane, within `flat` [m], belongs to the side that it bounds.
void divide_corners(const Polygon& polygon, const HalfSpace& plane, double flat,
                    std::vector<Vec3>& below, std::vector<Vec3>& above) {
  const HeightRange range = heights(polygon, plane);
  if (range.high <= flat || range.low >= -flat) {
    bool is_above = range.high > flat;
    if (!is_above && range.low >= -flat) is_above = area_vector(polygon).dot(plane.n) < 0.0;
    std::vector<Vec3>& side = is_above ? above : below;
    side.insert(side.end(), polygon.begin(), polygon.end());
    return;
  }
  for_each_corner(polygon, plane, [&](const Vec3& p, double height) {
    if (height <= 0.0) below.push_back(p);
    if (height >= 0.0) above.push_back(p);
  });
}

class Cutting {
 public:
  Cutting(const Solid& solid, double error, double thickness,
          const std::function<void(const std::string&)>& progress)
      : solid_(solid), error_(error), thickness_(thickness), progress_(progress) {}

  PointSets run(int most) {
    Region whole;
    whole.polygons.reserve(solid_.as_given().size());
    for (const Triangle& t : solid_.as_given()) whole.polygons.emplace_back(t.begin(), t.end());
    const Vec3 around = Vec3::Constant(solid_.size());
    whole.cell = Polytope::box(solid_.bounds().low - around, solid_.bounds().high + around);
    regions_.push_back(measured(std::move(whole)));
    while (static_cast<int>(regions_.size()) < 2 * most) {
      const std::optional<std::size_t> worst = worst_region();
      if (!worst) break;
      divide(*worst);
      if (progress_) {
        progress_(std::to_string(regions_.size()) + " parts, excess " +
                  std::to_string(1e3 * largest()) + " mm");
      }
    }
    merge(most);
    PointSets parts;
    for (const Region& region : regions_) parts.push_back(region.hull.vertices);
    return parts;
  }

 private:
  [[nodiscard]] ExcessOptions coarse() const { return {.gap = 0.1 * error_, .most_pieces = 2'000}; }

  /// The hull of what of the solid is in the cell: of the surface there, and of the corners of the
  /// cell that are inside.
  Region measured(Region region) const {
    std::vector<Vec3> points = corners_inside(region.cell);
    for (const Polygon& polygon : region.polygons) {
      points.insert(points.end(), polygon.begin(), polygon.end());
    }
    region.hull = ConvexPart::of(points, thickness_);
    region.excess = excess_of(region.hull, solid_, coarse());
    return region;
  }

  [[nodiscard]] std::vector<Vec3> corners_inside(const Polytope& cell) const {
    std::vector<Vec3> inside;
    for (const Vec3& p : cell.corners()) {
      if (solid_.has_inside(p)) inside.push_back(p);
    }
    return inside;
  }

  [[nodiscard]] double largest() const {
    double most = 0.0;
    for (const Region& region : regions_) most = std::max(most, region.excess.bound);
    return most;
  }

  [[nodiscard]] std::optional<std::size_t> worst_region() const {
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      const Region& region = regions_[i];
      if (region.is_final || region.excess.bound <= error_) continue;
      if (!worst || region.excess.bound > regions_[*worst].excess.bound) worst = i;
    }
    return worst;
  }

  struct Halves {
    std::vector<Polygon> below, above;
  };

  /// What lies in the plane belongs to the side that it bounds; of an open surface it is apart if
  /// nothing else is on one side.
  [[nodiscard]] Halves cut(const std::vector<Polygon>& polygons, const HalfSpace& plane) const {
    const double flat = 1e-9 * solid_.size();
    const HalfSpace other{-plane.n, -plane.offset};
    Halves result;
    std::vector<Polygon> in_plane;
    for (const Polygon& polygon : polygons) {
      const HeightRange range = heights(polygon, plane);
      if (range.low >= -flat && range.high <= flat) {
        in_plane.push_back(polygon);
      } else if (range.high <= flat) {
        result.below.push_back(polygon);
      } else if (range.low >= -flat) {
        result.above.push_back(polygon);
      } else {
        result.below.push_back(clipped(polygon, plane));
        result.above.push_back(clipped(polygon, other));
      }
    }
    for (Polygon& polygon : in_plane) {
      bool is_above = area_vector(polygon).dot(plane.n) < 0.0;
      if (!solid_.is_closed()) is_above = result.above.empty();
      (is_above ? result.above : result.below).push_back(std::move(polygon));
    }
    return result;
  }

  struct Candidate {
    HalfSpace plane;
    double area = 0.0;  ///< [m^2] of the polygons in it
  };

  /// The planes of most area, those near where the region reaches out farthest, and planes across
  /// the axes.
  [[nodiscard]] std::vector<HalfSpace> candidates(const Region& region) const {
    constexpr std::size_t most_of_area = 24;
    constexpr std::size_t most_near = 16;
    std::vector<Candidate> found;
    for (const Polygon& polygon : region.polygons) add(polygon, found);
    std::sort(found.begin(), found.end(),
              [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
    std::vector<HalfSpace> planes;
    for (std::size_t i = 0; i < std::min(found.size(), most_of_area); ++i) {
      planes.push_back(found[i].plane);
    }
    std::sort(found.begin(), found.end(), [&](const Candidate& a, const Candidate& b) {
      return std::abs(a.plane.height(region.excess.at)) <
             std::abs(b.plane.height(region.excess.at));
    });
    for (std::size_t i = 0; i < std::min(found.size(), most_near); ++i) {
      planes.push_back(found[i].plane);
    }
    add_across(region.excess.at, planes);
    const Vec3 middle = 0.5 * Vec3(region.hull.low + region.hull.high);
    for (int axis = 0; axis < 3; ++axis) {
      planes.push_back({Vec3::Unit(axis), middle[axis]});
      planes.push_back({Vec3::Unit(axis), region.excess.at[axis]});
    }
    return planes;
  }

  /// Planes through the point that is farthest out, along the way from there to the surface: what
  /// is bent around it is cut across.
  void add_across(const Vec3& at, std::vector<HalfSpace>& planes) const {
    constexpr int turns = 6;
    const auto nearest = solid_.surface().nearest(at);
    const Triangle& t = solid_.surface().triangles()[nearest.triangle];
    const Vec3 way = nearest_in_triangle(at, t[0], t[1], t[2]) - at;
    if (way.norm() < 1e-9 * solid_.size()) return;
    const Vec3 u = way.unitOrthogonal();
    const Vec3 v = way.normalized().cross(u);
    for (int i = 0; i < turns; ++i) {
      const double angle = std::numbers::pi * i / turns;
      const Vec3 n = std::cos(angle) * u + std::sin(angle) * v;
      planes.push_back({n, n.dot(at)});
    }
  }

  void add(const Polygon& polygon, std::vector<Candidate>& found) const {
    constexpr std::size_t most = 400;  // of a finely meshed surface the first ones will do
    constexpr double same_direction = 1e-6;
    const Vec3 area = area_vector(polygon);
    const double size = area.norm();
    if (size == 0.0) return;
    const Vec3 n = area / size;
    const double offset = n.dot(polygon[0]);
    for (Candidate& known : found) {
      if (known.plane.n.dot(n) > 1.0 - same_direction &&
          std::abs(known.plane.offset - offset) < 1e-5 * solid_.size()) {
        known.area += size;
        return;
      }
    }
    if (found.size() < most) found.push_back({{n, offset}, size});
  }

  void divide(std::size_t index) {
    const Region& region = regions_[index];
    const double volume = region.hull.volume();
    double best = 1e300;
    std::optional<HalfSpace> plane;
    for (const HalfSpace& candidate : candidates(region)) {
      const HeightRange range = heights(region.hull.vertices, candidate);
      if (range.low > -error_ || range.high < error_) continue;
      const double score = score_of(region, candidate, volume);
      if (score < best) {
        best = score;
        plane = candidate;
      }
    }
    if (!plane) {
      regions_[index].is_final = true;
      return;
    }
    Halves halves = cut(region.polygons, *plane);
    Region below{std::move(halves.below), region.cell.clipped(*plane), {}, {}, false};
    Region above{
        std::move(halves.above), region.cell.clipped({-plane->n, -plane->offset}), {}, {}, false};
    regions_[index] = measured(std::move(below));
    regions_.push_back(measured(std::move(above)));
  }

  /// The volume that is left, as a share. Of two cuts that are alike, as all are that first cut a
  /// ring, the one that leaves compact halves, then the one that divides evenly. Of a finely meshed
  /// surface some polygons will do.
  [[nodiscard]] double score_of(const Region& region, const HalfSpace& plane, double volume) const {
    constexpr double for_evenness = 0.01;
    constexpr double for_size = 0.05;
    constexpr std::size_t most = 1500;
    std::vector<Vec3> below = corners_inside(region.cell.clipped(plane));
    std::vector<Vec3> above = corners_inside(region.cell.clipped({-plane.n, -plane.offset}));
    const std::size_t step = 1 + region.polygons.size() / most;
    for (std::size_t i = 0; i < region.polygons.size(); i += step) {
      divide_corners(region.polygons[i], plane, 1e-9 * solid_.size(), below, above);
    }
    const ConvexPart a = ConvexPart::of(below, thickness_);
    const ConvexPart b = ConvexPart::of(above, thickness_);
    const double volumes =
        a.volume() + b.volume() + for_evenness * std::abs(a.volume() - b.volume());
    const double sizes = (a.high - a.low).norm() + (b.high - b.low).norm();
    return volumes / std::max(volume, 1e-300) +
           for_size * sizes / Vec3(region.hull.high - region.hull.low).norm();
  }

  /// Whether a point between corners of two parts is out of the solid by more than the error: then
  /// their hull need not be made.
  [[nodiscard]] bool is_far_between(std::size_t i, std::size_t j) const {
    constexpr std::size_t most = 8;  // corners of each that are tried
    const std::vector<Vec3>& a = regions_[i].hull.vertices;
    const std::vector<Vec3>& b = regions_[j].hull.vertices;
    for (std::size_t k = 0; k < a.size(); k += 1 + a.size() / most) {
      for (std::size_t l = 0; l < b.size(); l += 1 + b.size() / most) {
        const Vec3 p = 0.5 * Vec3(a[k] + b[l]);
        if (solid_.surface().nearest(p).distance > error_ && !solid_.has_inside(p)) return true;
      }
    }
    return false;
  }

  /// Joins parts whose hull is still within the error; and, while there are more than `most`,
  /// those whose hull reaches out least.
  void merge(int most) {
    const auto join = [&](std::size_t i, std::size_t j) {
      std::vector<Vec3> points = regions_[i].hull.vertices;
      points.insert(points.end(), regions_[j].hull.vertices.begin(),
                    regions_[j].hull.vertices.end());
      return ConvexPart::of(points, thickness_);
    };
    const auto touch = [&](std::size_t i, std::size_t j) {
      const Vec3 margin = Vec3::Constant(1e-6 * solid_.size());
      return Bounds{regions_[i].hull.low - margin, regions_[i].hull.high + margin}.meets(
          {regions_[j].hull.low, regions_[j].hull.high});
    };
    const auto replace = [&](std::size_t i, std::size_t j, ConvexPart hull, const Excess& excess) {
      regions_[i].hull = std::move(hull);
      regions_[i].excess = excess;
      regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(j));
    };
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      for (std::size_t j = i + 1; j < regions_.size(); ++j) {
        if (!touch(i, j) || is_far_between(i, j)) continue;
        ConvexPart hull = join(i, j);
        ExcessOptions options = coarse();
        options.enough = error_;
        const Excess excess = excess_of(hull, solid_, options);
        if (excess.bound > error_) continue;
        replace(i, j, std::move(hull), excess);
        j = i;  // what is larger now may take earlier ones as well
      }
    }
    while (static_cast<int>(regions_.size()) > most) {
      struct Pair {
        std::size_t i, j;
        double more;  ///< [m^3] volume of the hull
      };
      std::vector<Pair> pairs;
      for (std::size_t i = 0; i < regions_.size(); ++i) {
        for (std::size_t j = i + 1; j < regions_.size(); ++j) {
          pairs.push_back(
              {i, j, join(i, j).volume() - regions_[i].hull.volume() - regions_[j].hull.volume()});
        }
      }
      // The hull that reaches out least, among those that add little.
      constexpr std::size_t most_tried = 24;
      std::sort(pairs.begin(), pairs.end(),
                [](const Pair& a, const Pair& b) { return a.more < b.more; });
      if (pairs.size() > most_tried) pairs.resize(most_tried);
      Pair best = pairs[0];
      Excess least{1e300, 0.0, {0, 0, 0}};
      for (const Pair& pair : pairs) {
        ExcessOptions options = coarse();
        options.enough = least.bound;
        const Excess excess = excess_of(join(pair.i, pair.j), solid_, options);
        if (excess.bound >= least.bound) continue;
        least = excess;
        best = pair;
      }
      replace(best.i, best.j, join(best.i, best.j), least);
    }
  }

  const Solid& solid_;
  double error_;
  double thickness_;
  const std::function<void(const std::string&)>& progress_;
  std::vector<Region> regions_;
};

}  // namespace

PointSets cut_by_planes(const Solid& solid, int most, double error, double thickness,
                        const std::function<void(const std::string&)>& progress) {
  return Cutting(solid, error, thickness, progress).run(most);
}

}  // namespace repel::cover
