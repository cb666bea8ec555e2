/// @file
/// The facets of the convex hull of a set of points. Set-up only: it allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/types.hpp>

namespace repel {

/// The half space n.x <= offset that holds the hull and touches it in a facet.
struct Facet {
  std::array<int, 3> vertices{};  ///< indices, counter-clockwise seen from outside
  Vec3 n = Vec3::Zero();          ///< unit, outward
  double offset = 0.0;            ///< [m]
};

namespace detail {

/// Adds one point after the other: facets that see it go, their rim is joined to it.
class IncrementalHull {
 public:
  explicit IncrementalHull(std::span<const Vec3> points) : points_(points) {
    for (const Vec3& p : points) size_ = std::max(size_, p.cwiseAbs().maxCoeff());
    tolerance_ = 1e-12 * size_;
  }

  /// Empty when the points have no volume, or when rounding spoilt the hull.
  [[nodiscard]] std::vector<Facet> build() {
    if (!start()) return {};
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) add(i);
    for (Facet& f : facets_) {
      const double claimed = f.offset;
      for (const Vec3& p : points_) f.offset = std::max(f.offset, f.n.dot(p));
      if (!(f.offset - claimed <= 100.0 * tolerance_)) return {};
    }
    return facets_;
  }

 private:
  // Four points that span a volume, each the farthest from the span of those before it.
  bool start() {
    if (points_.size() < 4) return false;
    std::array<int, 4> s{};
    const auto farthest = [&](auto&& measure) {
      int best = 0;
      for (int i = 1; i < static_cast<int>(points_.size()); ++i) {
        if (measure(points_[i]) > measure(points_[best])) best = i;
      }
      return best;
    };
    s[0] = farthest([](const Vec3& p) { return p.x(); });
    const Vec3 o = points_[s[0]];
    s[1] = farthest([&](const Vec3& p) { return (p - o).norm(); });
    const Vec3 e = (points_[s[1]] - o).normalized();
    s[2] = farthest([&](const Vec3& p) { return (p - o).cross(e).norm(); });
    const Vec3 n = e.cross(points_[s[2]] - o).normalized();
    s[3] = farthest([&](const Vec3& p) { return std::abs((p - o).dot(n)); });
    const double height = (points_[s[3]] - o).dot(n);
    if (!(std::abs(height) > 10.0 * tolerance_)) return false;
    if (height > 0.0) std::swap(s[1], s[2]);
    for (const auto& f : {std::array{s[0], s[1], s[2]},
                          {s[0], s[3], s[1]},
                          {s[1], s[3], s[2]},
                          {s[2], s[3], s[0]}}) {
      push(f[0], f[1], f[2]);
    }
    return true;
  }

  void push(int a, int b, int c) {
    const Vec3 n = (points_[b] - points_[a]).cross(points_[c] - points_[a]).normalized();
    facets_.push_back({{a, b, c}, n, n.dot(points_[a])});
  }

  void add(int i) {
    std::set<std::pair<int, int>> rim;
    std::vector<Facet> hidden;
    for (const Facet& f : facets_) {
      if (!(f.n.dot(points_[i]) - f.offset > tolerance_)) {
        hidden.push_back(f);
        continue;
      }
      // An edge between two facets that both go meets its reverse and cancels.
      for (int k = 0; k < 3; ++k) {
        const std::pair edge{f.vertices[k], f.vertices[(k + 1) % 3]};
        if (rim.erase({edge.second, edge.first}) == 0) rim.insert(edge);
      }
    }
    if (hidden.size() == facets_.size()) return;
    facets_ = std::move(hidden);
    for (const auto& [from, to] : rim) push(from, to, i);
  }

  std::span<const Vec3> points_;
  double size_ = 0.0;
  double tolerance_ = 0.0;  ///< [m]
  std::vector<Facet> facets_;
};

}  // namespace detail

/// The triangulated facets of the hull of `points`; none when they lie in a plane, on a line or in
/// a point (within 1e-11 of their size). Every point is inside every half space, and each half
/// space touches the hull. Cost: points times facets.
[[nodiscard]] inline std::vector<Facet> hull_facets(std::span<const Vec3> points) {
  return detail::IncrementalHull(points).build();
}

}  // namespace repel
