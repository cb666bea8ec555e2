// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The point of a cylinder nearest to a vertex, an edge or a face.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include <repel/base/vec.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// Where a feature and a cylinder are nearest to each other.
struct CylinderFoot {
  bool found = false;
  Vec<double> on_cylinder{};  ///< [m]
  /// Of the corners of the feature, for its point; negative: it is beyond them, on their plane.
  Vec<double> weights{1.0, 0.0, 0.0};
  /// [m] From the one to the other, normal to what is straight at both to the last digit: other
  /// corners of the feature are as far along it.
  Vec<double> v{};
};

/// Finds it. A curved surface is taken as it is: a search by support points only comes nearer to it
/// with each of them. All points are in the frame of the cylinder [m].
class CylinderFootSearch {
 public:
  /// @param cylinder of a radius above 0
  explicit CylinderFootSearch(const Convex& cylinder) noexcept
      : cylinder_(cylinder),
        radius_(cylinder.round_size().x()),
        half_length_(cylinder.round_size().z()) {}

  /// Of one to three corners. Not found where a face meets the cylinder. Cost: that of some support
  /// points.
  [[nodiscard]] CylinderFoot run(std::span<const Vec<double>> corners) const noexcept {
    if (corners.size() == 1) return at_corner(corners[0], {1.0, 0.0, 0.0});
    return corners.size() == 2 ? on_edge(corners[0], corners[1]) : on_face(corners);
  }

 private:
  [[nodiscard]] Vec<double> nearest(const Vec<double>& p) const noexcept {
    const double across = p.x() * p.x() + p.y() * p.y();
    const double scale = across > radius_ * radius_ ? radius_ / std::sqrt(across) : 1.0;
    return {scale * p.x(), scale * p.y(), std::clamp(p.z(), -half_length_, half_length_)};
  }

  [[nodiscard]] CylinderFoot at_corner(const Vec<double>& p,
                                       const Vec<double>& weights) const noexcept {
    const Vec<double> c = nearest(p);
    return {true, c, weights, p - c};
  }

  /// Half the squared distance is convex along the edge: its slope ascends through zero at the
  /// foot, or the foot is an end. It bends where the edge crosses the plane of a disc, or
  /// the mantle.
  [[nodiscard]] CylinderFoot on_edge(const Vec<double>& p, const Vec<double>& q) const noexcept {
    const Vec<double> e = q - p;
    double low = 0.0;
    double high = 1.0;
    double slope_low = slope(p, e);
    double slope_high = slope(q, e);
    if (!(slope_low < 0.0)) return at_corner(p, {1.0, 0.0, 0.0});
    if (!(slope_high > 0.0)) return at_corner(q, {0.0, 1.0, 0.0});
    double t = 0.0;
    Vec<double> c;
    Vec<double> v;
    double here = 0.0;
    int stayed = 0;
    const auto look = [&](double at) {
      t = at;
      const Vec<double> x = p + t * e;
      c = nearest(x);
      v = x - c;
      here = dot(v, e);
      const int moved = here < 0.0 ? -1 : 1;
      (moved < 0 ? low : high) = t;
      (moved < 0 ? slope_low : slope_high) = here;
      // Regula falsi with the Illinois rule: the slope at an end that stays is halved.
      if (moved == stayed) (moved < 0 ? slope_high : slope_low) *= 0.5;
      stayed = moved;
    };
    // Beside the cylinder, it is where the edge is nearest to the axis.
    const double across = e.x() * e.x() + e.y() * e.y();
    const double beside = -(p.x() * e.x() + p.y() * e.y()) / across;
    const Vec<double> middle = p + beside * e;
    const double off = middle.x() * middle.x() + middle.y() * middle.y();
    const double to_rim = std::sqrt(std::max(0.0, radius_ * radius_ - off) / across);
    for (const double at : {(-half_length_ - p.z()) / e.z(), (half_length_ - p.z()) / e.z(),
                            beside - to_rim, beside + to_rim, beside}) {
      if (at > low && at < high) look(at);
    }
    const double ee = dot(e, e);
    int left = 24;
    do {
      look(low + (high - low) * (slope_low / (slope_low - slope_high)));
    } while (here * here > 1e-22 * ee * dot(v, v) && --left > 0);
    return {true, c, {1.0 - t, t, 0.0}, normal_part(v, c, e, here)};
  }
  /// The part of v that is normal to the edge and, beside the cylinder, to its axis.
  /// @param along of v and e
  [[nodiscard]] Vec<double> normal_part(const Vec<double>& v, const Vec<double>& c,
                                        const Vec<double>& e, double along) const noexcept {
    const double ee = dot(e, e);
    if (along * along <= 1e-31 * ee * dot(v, v)) return v;  // it is; e may be along the axis
    if (std::abs(c.z()) == half_length_) return v - (along / ee) * e;
    const Vec<double> n(e.y(), -e.x(), 0.0);
    return (dot(v, n) / dot(n, n)) * n;
  }
  /// Of half the squared distance along `e`, at `x`.
  [[nodiscard]] double slope(const Vec<double>& x, const Vec<double>& e) const noexcept {
    return dot(x - nearest(x), e);
  }

  /// The point that is farthest towards the plane.
  [[nodiscard]] CylinderFoot on_face(std::span<const Vec<double>> corners) const noexcept {
    const Vec<double>& p = corners[0];
    Vec<double> n = cross(corners[1] - p, corners[2] - p);
    if (dot(n, p) < 0.0) n = -n;
    const double nn = dot(n, n);
    if (!(nn > 0.0)) return {};
    const Vec<double> c = cylinder_.support(n).p;
    const double ahead = dot(n, p - c);
    if (!(ahead > 0.0)) return {};
    const Vec<double> foot = c + (ahead / nn) * n;
    const Vec<double> to_p = p - foot;
    const Vec<double> to_q = corners[1] - foot;
    const Vec<double> to_r = corners[2] - foot;
    const Vec<double> areas = dots(cross(to_q, to_r), cross(to_r, to_p), cross(to_p, to_q),
                                   cross(to_q - to_p, to_r - to_p));
    return {true, c, (1.0 / sum(areas)) * areas, (ahead / nn) * n};
  }

  const Convex& cylinder_;
  double radius_;
  double half_length_;
};

}  // namespace repel::detail
