// SPDX-License-Identifier: BSD-3-Clause
#include "coverage.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace repel::cover {
namespace {

/// The pieces of `polygon` outside of `part`, appended to `outside`.
void subtract(const Polygon& polygon, const ConvexPart& part, double margin,
              std::vector<Polygon>& outside) {
  const auto apart = std::any_of(part.planes.begin(), part.planes.end(), [&](const HalfSpace& h) {
    return heights(polygon, h).low > margin;
  });
  if (apart || part.planes.empty()) {
    outside.push_back(polygon);
    return;
  }
  Polygon rest = polygon;
  std::vector<Polygon> pieces;
  for (const HalfSpace& plane : part.planes) {
    if (heights(rest, plane).high <= margin) continue;
    const HalfSpace beyond{-plane.n, -plane.offset - margin};
    Polygon piece = clipped(rest, beyond);
    if (!piece.empty()) pieces.push_back(std::move(piece));
    rest = clipped(rest, {plane.n, plane.offset + margin});
    if (rest.empty()) break;
  }
  // A corner that only touches the part would be cut in vain.
  if (rest.size() < 3 && polygon.size() >= 3) {
    outside.push_back(polygon);
  } else {
    std::move(pieces.begin(), pieces.end(), std::back_inserter(outside));
  }
}

bool is_in_one(const Triangle& t, std::span<const ConvexPart> parts, double margin) {
  return std::any_of(parts.begin(), parts.end(), [&](const ConvexPart& part) {
    return part.contains(t[0], margin) && part.contains(t[1], margin) &&
           part.contains(t[2], margin);
  });
}

Gap gap_of(Polygon polygon, std::span<const ConvexPart> parts) {
  Gap gap{std::move(polygon), 1e300, -1};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    double farthest = 0.0;  // at a corner: the distance from a convex part is a convex function
    for (const Vec3& p : gap.polygon) {
      farthest = std::max(farthest, parts[i].distance(p));
      if (farthest >= gap.depth) break;
    }
    if (farthest < gap.depth) {
      gap.depth = farthest;
      gap.nearest = static_cast<int>(i);
    }
  }
  return gap;
}

/// The two halves of a polygon, across the line between its two farthest corners.
std::array<Polygon, 2> halves(const Polygon& polygon) {
  Vec3 a = polygon[0];
  Vec3 b = polygon[0];
  for (const Vec3& p : polygon) {
    for (const Vec3& q : polygon) {
      if ((p - q).squaredNorm() > (a - b).squaredNorm()) {
        a = p;
        b = q;
      }
    }
  }
  const Vec3 n = (b - a).normalized();
  const double offset = 0.5 * n.dot(a + b);
  return {clipped(polygon, {n, offset}), clipped(polygon, {-n, -offset})};
}

double extent(const Polygon& polygon) {
  Bounds box;
  for (const Vec3& p : polygon) box.add(p);
  return (box.high - box.low).norm();
}

/// Gives a gap to parts; returns what none takes.
class Giving {
 public:
  Giving(std::span<const ConvexPart> parts, double most)
      : parts_(parts), most_(most), joined_(parts.size()) {}

  // NOLINTNEXTLINE(misc-no-recursion): each half is shorter, and a short one is not halved
  void give(Gap gap) {
    if (gap.nearest >= 0 && gap.depth > 0.25 * most_ && extent(gap.polygon) > most_) {
      for (Polygon& half : halves(gap.polygon)) {
        if (half.size() >= 3) give(gap_of(std::move(half), parts_));
      }
    } else if (gap.nearest < 0 || gap.depth > most_) {
      kept_.push_back(std::move(gap));
    } else {
      auto& points = joined_[gap.nearest];
      points.insert(points.end(), gap.polygon.begin(), gap.polygon.end());
    }
  }

  [[nodiscard]] const std::vector<std::vector<Vec3>>& joined() const { return joined_; }
  [[nodiscard]] std::vector<Gap> take_kept() { return std::move(kept_); }

 private:
  std::span<const ConvexPart> parts_;
  double most_;
  std::vector<std::vector<Vec3>> joined_;
  std::vector<Gap> kept_;
};

}  // namespace

std::vector<Gap> gaps_in(std::span<const Triangle> surface, std::span<const ConvexPart> parts,
                         double margin) {
  std::vector<Gap> gaps;
  for (const Triangle& t : surface) {
    if (is_in_one(t, parts, margin)) continue;
    std::vector<Polygon> left{Polygon(t.begin(), t.end())};
    Bounds box;
    for (const Vec3& p : t) box.add(p);
    for (const ConvexPart& part : parts) {
      if (left.empty()) break;
      if (part.planes.empty() || !box.meets({part.low, part.high})) continue;
      std::vector<Polygon> next;
      for (const Polygon& polygon : left) subtract(polygon, part, margin, next);
      left = std::move(next);
    }
    for (Polygon& polygon : left) {
      // What a part only touches is left by it, and may be all that is left by the next one.
      Gap gap = gap_of(std::move(polygon), parts);
      if (gap.depth > margin) gaps.push_back(std::move(gap));
    }
  }
  return gaps;
}

std::vector<Gap> fill_gaps(std::span<const Triangle> surface, std::vector<ConvexPart>& parts,
                           double margin, double most, double thickness) {
  constexpr int most_rounds = 4;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<Gap> gaps = gaps_in(surface, parts, margin);
    if (gaps.empty()) return {};
    Giving giving(parts, most);
    for (Gap& gap : gaps) giving.give(std::move(gap));
    bool has_grown = false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::vector<Vec3> points = giving.joined()[i];
      if (points.empty()) continue;
      points.insert(points.end(), parts[i].vertices.begin(), parts[i].vertices.end());
      parts[i] = ConvexPart::of(points, thickness);
      has_grown = true;
    }
    if (!has_grown) break;
  }
  return gaps_in(surface, parts, margin);
}

}  // namespace repel::cover
