#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "coverage.hpp"
#include "engines.hpp"
#include "excess.hpp"

namespace repel::cover {
namespace {

/// A part of the surface.
struct Region {
  std::vector<Polygon> polygons;
  ConvexPart hull;
  Excess excess;
  bool is_final = false;  ///< no plane divides it
};

std::vector<Vec3> corners_of(const std::vector<Polygon>& polygons) {
  std::vector<Vec3> points;
  for (const Polygon& polygon : polygons) {
    points.insert(points.end(), polygon.begin(), polygon.end());
  }
  return points;
}

Vec3 area_vector(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += 0.5 * Vec3(polygon[i - 1] - polygon[0]).cross(Vec3(polygon[i] - polygon[0]));
  }
  return sum;
}

class Cutting {
 public:
  Cutting(const Solid& solid, double error, double thickness,
          const std::function<void(const std::string&)>& progress)
      : solid_(solid), error_(error), thickness_(thickness), progress_(progress) {}

  PointSets run(int most) {
    std::vector<Polygon> all;
    all.reserve(solid_.as_given().size());
    for (const Triangle& t : solid_.as_given()) all.emplace_back(t.begin(), t.end());
    regions_.push_back(region_of(std::move(all)));
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
  [[nodiscard]] ExcessOptions coarse() const { return {.gap = 0.1 * error_, .most_pieces = 5'000}; }

  Region region_of(std::vector<Polygon> polygons) const {
    Region region;
    region.hull = ConvexPart::of(corners_of(polygons), thickness_);
    region.polygons = std::move(polygons);
    region.excess = excess_of(region.hull, solid_, coarse());
    return region;
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
    const Vec3 middle = 0.5 * Vec3(region.hull.low + region.hull.high);
    for (int axis = 0; axis < 3; ++axis) {
      planes.push_back({Vec3::Unit(axis), middle[axis]});
      planes.push_back({Vec3::Unit(axis), region.excess.at[axis]});
    }
    return planes;
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
    regions_[index] = region_of(std::move(halves.below));
    regions_.push_back(region_of(std::move(halves.above)));
  }

  /// The volume that is left, as a share; of two that are alike, the one that divides evenly.
  [[nodiscard]] double score_of(const Region& region, const HalfSpace& plane, double volume) const {
    constexpr double for_evenness = 0.01;
    const Halves halves = cut(region.polygons, plane);
    if (halves.below.empty() || halves.above.empty()) return 1e300;
    const double below = ConvexPart::of(corners_of(halves.below), thickness_).volume();
    const double above = ConvexPart::of(corners_of(halves.above), thickness_).volume();
    return (below + above + for_evenness * std::abs(below - above)) / std::max(volume, 1e-300);
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
        if (!touch(i, j)) continue;
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
      std::size_t a = 0;
      std::size_t b = 1;
      double least = 1e300;
      for (std::size_t i = 0; i < regions_.size(); ++i) {
        for (std::size_t j = i + 1; j < regions_.size(); ++j) {
          const double more =
              join(i, j).volume() - regions_[i].hull.volume() - regions_[j].hull.volume();
          if (more >= least) continue;
          least = more;
          a = i;
          b = j;
        }
      }
      ConvexPart hull = join(a, b);
      const Excess excess = excess_of(hull, solid_, coarse());
      replace(a, b, std::move(hull), excess);
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
