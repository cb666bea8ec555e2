// SPDX-License-Identifier: BSD-3-Clause
#include "box_hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "polytope.hpp"

namespace repel::cover {
namespace {

/// Whether the line p + s d, s >= 0, meets the box.
bool ray_meets(const Bounds& box, const Vec3& p, const Vec3& inverse) {
  double near = 0.0;
  double far = 1e300;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.low[i] - p[i]) * inverse[i];
    const double b = (box.high[i] - p[i]) * inverse[i];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  // Wider than rounding: a box that is missed would lose a crossing.
  return near <= far * (1.0 + 1e-12);
}

}  // namespace

BoxHierarchy::BoxHierarchy(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> middles;
  middles.reserve(triangles_.size());
  for (const Triangle& t : triangles_) middles.push_back((t[0] + t[1] + t[2]) / 3.0);
  if (!triangles_.empty()) build(0, static_cast<int>(triangles_.size()), middles);
}

// NOLINTNEXTLINE(misc-no-recursion): halves each time
int BoxHierarchy::build(int first, int last, std::vector<Vec3>& middles) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Bounds box;
  Bounds of_middles;
  for (int i = first; i < last; ++i) {
    for (const Vec3& p : triangles_[order_[i]]) box.add(p);
    of_middles.add(middles[order_[i]]);
  }
  nodes_[index].box = box;
  if (last - first <= leaf_size) {
    nodes_[index].first = first;
    nodes_[index].count = last - first;
    return index;
  }
  int axis = 0;
  (of_middles.high - of_middles.low).maxCoeff(&axis);
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int a, int b) { return middles[a][axis] < middles[b][axis]; });
  build(first, middle, middles);
  const int second = build(middle, last, middles);
  nodes_[index].second = second;
  return index;
}

BoxHierarchy::Nearest BoxHierarchy::nearest(const Vec3& p) const {
  Nearest best;
  if (nodes_.empty()) return best;
  double squared = 1e300;
  std::array<std::pair<int, double>, 128> waiting;
  int count = 0;
  waiting[count++] = {0, nodes_[0].box.squared_distance(p)};
  while (count > 0) {
    const auto [index, distance] = waiting[--count];
    if (distance >= squared) continue;
    const Node& node = nodes_[index];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[order_[i]];
      const double d = (p - nearest_in_triangle(p, t[0], t[1], t[2])).squaredNorm();
      if (d < squared) {
        squared = d;
        best.triangle = order_[i];
      }
    }
    if (node.second == 0) continue;
    std::pair<int, double> one{index + 1, nodes_[index + 1].box.squared_distance(p)};
    std::pair<int, double> other{node.second, nodes_[node.second].box.squared_distance(p)};
    if (one.second < other.second) std::swap(one, other);
    waiting[count++] = one;
    waiting[count++] = other;  // the nearer one is looked at first
  }
  best.distance = std::sqrt(squared);
  return best;
}

template <class Meets, class See>
bool BoxHierarchy::visit(const Meets& meets, const See& see) const {
  if (nodes_.empty()) return true;
  std::array<int, 128> waiting;
  int count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const int index = waiting[--count];
    const Node& node = nodes_[index];
    if (!meets(node.box)) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (!see(order_[i])) return false;
    }
    if (node.second == 0) continue;
    waiting[count++] = index + 1;
    waiting[count++] = node.second;
  }
  return true;
}

bool BoxHierarchy::overlapping(const Bounds& box, std::size_t most, std::vector<int>& found) const {
  found.clear();
  return visit([&](const Bounds& node) { return node.meets(box); },
               [&](int index) {
                 Bounds of_triangle;
                 for (const Vec3& p : triangles_[index]) of_triangle.add(p);
                 if (!of_triangle.meets(box)) return true;
                 if (found.size() == most) return false;
                 found.push_back(index);
                 return true;
               });
}

BoxHierarchy::Crossings BoxHierarchy::crossings(const Vec3& p, const Vec3& direction) const {
  constexpr double doubt = 1e-9;  // as a share of the triangle
  const Vec3 inverse = direction.cwiseInverse();
  Crossings result;
  const auto see = [&](int index) {
    const Triangle& t = triangles_[index];
    const Vec3 u = t[1] - t[0];
    const Vec3 v = t[2] - t[0];
    const Vec3 n = u.cross(v);
    const double along = n.dot(direction);
    const Vec3 r = p - t[0];
    const double above = n.dot(r);
    if (along != 0.0 && -above / along < 0.0) return true;  // behind
    const Vec3 q = r.cross(direction);
    // Shares of the corners, times `along`.
    const double a = -v.dot(q);
    const double b = u.dot(q);
    const double c = along - a - b;
    const double sign = along > 0.0 ? 1.0 : -1.0;
    const double least = std::min({sign * a, sign * b, sign * c});
    const double size = std::abs(along) + std::abs(a) + std::abs(b);
    if (least > doubt * size) {
      result.count += along > 0.0 ? 1 : -1;
    } else if (least > -doubt * size) {
      result.is_doubtful = true;
    }
    return !result.is_doubtful;
  };
  (void)visit([&](const Bounds& box) { return ray_meets(box, p, inverse); }, see);
  return result;
}

int BoxHierarchy::winding_number(const Vec3& p) const {
  if (nodes_.empty()) return 0;
  constexpr int most_rays = 64;
  // Directions without a pattern, the same in every run.
  for (int i = 1; i <= most_rays; ++i) {
    const double z = 2.0 * std::fmod(0.5 + 0.7548776662466927 * i, 1.0) - 1.0;
    const double angle = 6.283185307179586 * std::fmod(0.3 + 0.5698402909980532 * i, 1.0);
    const double radius = std::sqrt(1.0 - z * z);
    const Crossings found = crossings(p, {radius * std::cos(angle), radius * std::sin(angle), z});
    if (!found.is_doubtful) return found.count;
  }
  return 0;
}

}  // namespace repel::cover
