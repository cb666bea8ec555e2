// SPDX-License-Identifier: BSD-3-Clause
#include "excess.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace repel::cover {
namespace {

/// The planes that pass through one piece, up to so many; a piece with more is halved.
constexpr std::size_t most_planes = 32;

class Search {
 public:
  Search(const Solid& solid, const ExcessOptions& options)
      : solid_(solid), options_(options), thin_(1e-6 * solid.size()) {}

  Excess run(Polytope part) {
    put(std::move(part), 1e300);
    for (int pieces = 0; !waiting_.empty(); ++pieces) {
      const double bound = waiting_.top().bound;
      if (bound <= reached_ + options_.gap || reached_ > options_.enough ||
          pieces >= options_.most_pieces) {
        return {std::max(bound, dropped_), reached_, at_};
      }
      const Piece piece = waiting_.top();
      waiting_.pop();
      halve(piece);
    }
    return {dropped_, reached_, at_};
  }

 private:
  struct Piece {
    double bound = 0.0;
    Polytope shape;
    bool operator<(const Piece& other) const { return bound < other.bound; }
  };

  void halve(const Piece& piece) {
    const Bounds box = bounds_of(piece.shape.corners());
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    const double middle = 0.5 * (box.low[axis] + box.high[axis]);
    const Vec3 n = Vec3::Unit(axis);
    put(piece.shape.clipped({n, middle}), piece.bound);
    put(piece.shape.clipped({-n, -middle}), piece.bound);
  }

  static Bounds bounds_of(const std::vector<Vec3>& points) {
    Bounds box;
    for (const Vec3& p : points) box.add(p);
    return box;
  }

  /// Bounds a piece, and lets it wait for its halves if that is not enough.
  void put(Polytope shape, double above) {
    if (shape.empty()) return;
    const double bound = std::min(above, bound_of(shape));
    if (bound <= reached_ + options_.gap) {
      dropped_ = std::max(dropped_, bound);
    } else {
      waiting_.push({bound, std::move(shape)});
    }
  }

  void reach(const Vec3& p) {
    const double distance = solid_.surface().nearest(p).distance;
    if (distance <= reached_ || solid_.has_inside(p)) return;
    reached_ = distance;
    at_ = p;
  }

  double bound_of(const Polytope& shape) {
    const std::vector<Vec3> corners = shape.corners();
    const Bounds box = bounds_of(corners);
    const Vec3 middle = 0.5 * Vec3(box.low + box.high);
    double radius = 0.0;
    for (const Vec3& p : corners) radius = std::max(radius, (p - middle).norm());
    const auto nearest = solid_.surface().nearest(middle);
    const double far = nearest.distance + radius;
    if (far <= reached_ + options_.gap) return far;
    if (nearest.distance > radius) {  // no surface in it
      return solid_.has_inside(middle) ? 0.0 : std::min(far, outside(corners));
    }
    std::vector<int> met;
    if (!solid_.surface().overlapping(box, 4 * most_planes, met)) return far;
    std::vector<HalfSpace> planes;
    for (const int i : met) add_plane(corners, solid_.surface().triangles()[i], planes);
    if (planes.size() > most_planes) return far;
    return std::min(far, divided(shape, planes, 0));
  }

  /// Adds the plane of a triangle if it divides the corners and is not there yet.
  void add_plane(const std::vector<Vec3>& corners, const Triangle& t,
                 std::vector<HalfSpace>& planes) const {
    const Vec3 n = Vec3(t[1] - t[0]).cross(Vec3(t[2] - t[0])).normalized();
    const HalfSpace plane{n, n.dot(t[0])};
    const HeightRange range = heights(corners, plane);
    if (range.low >= 0.0 || range.high <= 0.0) return;
    const bool is_known = std::any_of(planes.begin(), planes.end(), [&](const HalfSpace& known) {
      return known.n == plane.n && known.offset == plane.offset;
    });
    if (!is_known) planes.push_back(plane);
  }

  /// A bound for what is outside of the solid, by dividing along `planes` from the given one on. In
  /// a cell on one side of every plane there is no surface: all of it is inside, or nothing is.
  // NOLINTNEXTLINE(misc-no-recursion): each level takes a plane
  double divided(const Polytope& shape, const std::vector<HalfSpace>& planes, std::size_t first) {
    if (shape.empty()) return 0.0;
    const std::vector<Vec3> corners = shape.corners();
    for (std::size_t i = first; i < planes.size(); ++i) {
      const HeightRange range = heights(corners, planes[i]);
      // A thinner slice is left where it is, see whole().
      if (range.high <= thin_ || range.low >= -thin_) continue;
      const HalfSpace other{-planes[i].n, -planes[i].offset};
      const double below = divided(shape.clipped(planes[i]), planes, i + 1);
      return std::max(below, divided(shape.clipped(other), planes, i + 1));
    }
    return whole(corners, planes);
  }

  /// The same for a cell that is not divided. Planes may pass through thin slices of it. A point of
  /// such a slice, at height t above a plane, is on a line to the middle of the cell, at depth h
  /// below the plane: the point of that line in the plane is t / (t + h) of its length away.
  double whole(const std::vector<Vec3>& corners, const std::vector<HalfSpace>& planes) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
    double longest = 0.0;
    for (const Vec3& p : corners) longest = std::max(longest, (p - middle).norm());
    double slack = 0.0;
    bool is_clear = true;
    for (const HalfSpace& plane : planes) {
      const HeightRange range = heights(corners, plane);
      const double at = plane.height(middle);
      const double beyond = at < 0.0 ? range.high : -range.low;
      if (std::abs(at) <= thin_) is_clear = false;
      if (beyond > 0.0) slack = std::max(slack, longest * beyond / (beyond + std::abs(at)));
    }
    if (is_clear && solid_.has_inside(middle)) return slack;
    return outside(corners);
  }

  /// A bound for a cell that is outside.
  double outside(const std::vector<Vec3>& corners) {
    double best = 1e300;
    int last = -1;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
    const auto try_triangle = [&](int i) {
      if (i == last) return;
      last = i;
      best = std::min(best, largest_distance(corners, solid_.surface().triangles()[i]));
    };
    try_triangle(solid_.surface().nearest(middle).triangle);
    if (best <= reached_ + options_.gap) return best;
    for (const Vec3& p : corners) {
      try_triangle(solid_.surface().nearest(p).triangle);
      reach(p);
    }
    return best;
  }

  const Solid& solid_;
  ExcessOptions options_;
  double thin_;
  double reached_ = 0.0;
  double dropped_ = 0.0;
  Vec3 at_{0, 0, 0};
  std::priority_queue<Piece> waiting_;
};

}  // namespace

Excess excess_of(const ConvexPart& part, const Solid& solid, const ExcessOptions& options) {
  return Search(solid, options).run(Polytope::hull(part.vertices));
}

double mean_excess(std::span<const ConvexPart> parts, const Solid& solid, int samples) {
  std::vector<std::pair<std::size_t, const Polygon*>> facets;
  std::vector<double> areas;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const Polygon& f : parts[i].facets) {
      facets.emplace_back(i, &f);
      areas.push_back(Vec3(f[1] - f[0]).cross(Vec3(f[2] - f[0])).norm());
    }
  }
  if (facets.empty()) return 0.0;
  std::mt19937_64 random(1);
  std::vector<double> sums(areas.size());
  std::partial_sum(areas.begin(), areas.end(), sums.begin());
  const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11U), -53); };
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < samples; ++k) {
    const auto drawn = std::upper_bound(sums.begin(), sums.end(), uniform() * sums.back());
    const auto& [owner, f] = facets[std::min<std::size_t>(drawn - sums.begin(), sums.size() - 1)];
    double a = uniform();
    double b = uniform();
    if (a + b > 1.0) {
      a = 1.0 - a;
      b = 1.0 - b;
    }
    const Vec3 p = (*f)[0] + a * Vec3((*f)[1] - (*f)[0]) + b * Vec3((*f)[2] - (*f)[0]);
    bool is_hidden = false;
    for (std::size_t i = 0; i < parts.size() && !is_hidden; ++i) {
      is_hidden = i != owner && parts[i].contains(p, 0.0);
    }
    if (is_hidden) continue;
    sum += solid.distance(p);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace repel::cover
