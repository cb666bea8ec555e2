// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The mean over a disc of small tilts of the nearest point of two flat features.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <repel/contact/plane.hpp>
#include <repel/contact/turn.hpp>

namespace repel::detail {

/// Over an outline P, the gap of two flat features is linear, g(r) = g(0) - s.r, and with A tilted
/// by theta it is g(r) - theta.r. Its minimum, averaged over the disc |theta| <= e, is
///
///     g(0) - H(s)   with   H(s) = E[h(s + theta)]   and   h(y) = max of y.r over P
///
/// h is the support function of P; with y in the normal cone of corner i, corner i is the nearest.
/// So the mean nearest point is the sum of the corners weighted by the share of the disc around s
/// that lies in their cones. It moves continuously with s and with P, as it depends on the set P
/// only. With the whole disc in the cone of a corner it is that corner; at s = 0 it is the Steiner
/// point of P. Sides of A move with A: y is a sum of multiples of the outward normals of the two
/// sides at the corner, and those of sides of A pull on A.
///
/// At parallel faces, the mean is less than the gap by H(0). To make the distance the gap there, w
/// H(0) is added for polygons. The weight w is 1 at s = 0, and 0 once s, or the angle between a
/// feature and the tangent plane, is `faded` e.
class TiltMean {
 public:
  static constexpr double faded = 10.0;

  /// @param outline 2 or more corners, no two of them equal
  /// @param sides of the outline, which must be closed
  /// @param slope s, minus the gradient of the gap
  /// @param tilt e [rad], more than 0
  /// @param off the larger slope of the two features against the tangent plane
  TiltMean(const Outline& outline, const Sides& sides, const Planar& slope, double tilt,
           double off) noexcept
      : is_exact_(outline.is_exact), s_(slope), e_(tilt), fade_(slope, off, tilt) {
    if (outline.size == 2) {
      average_segment(outline);
    } else {
      average_polygon(outline, sides);
    }
  }

  /// H(s) - w H(0) [m], see above: the gap at r = 0 less the mean gap, less the same at s = 0 by
  /// the weight. Parallel features give 0.
  [[nodiscard]] double nearer() const noexcept { return nearer_; }
  /// [m] Its gradient by s: the mean nearest point, and up to a seventh of the size of P beyond.
  [[nodiscard]] const Planar& point() const noexcept { return point_; }
  /// The sum of the tangential forces t on A per unit of force, and [m] their moments r x t and
  /// (slope of A).r t.
  [[nodiscard]] const Planar& pull() const noexcept { return pull_; }
  /// The share of the disc for which the point r = 0 is the nearest.
  [[nodiscard]] double held() const noexcept { return held_; }
  /// Of a segment: [m^2] the mean square of the distance of the nearest point from r = 0, and [m]
  /// how H changes with the tilt.
  [[nodiscard]] double square() const noexcept { return square_; }
  [[nodiscard]] double widened() const noexcept { return widened_; }
  [[nodiscard]] double drill() const noexcept { return drill_; }
  [[nodiscard]] Planar lifted(const Planar& slope_of_a) const noexcept {
    return slope_of_a.x * x_pull_ + slope_of_a.y * y_pull_;
  }

 private:
  /// w and its gradient [1/rad] by s.
  struct Fade {
    double share = 0.0;
    Planar slope{};

    Fade(const Planar& s, double off, double tilt) noexcept {
      const double x = std::max(norm(s), off) / (faded * tilt);
      if (x >= 1.0) return;
      share = (1.0 - x * x) * (1.0 - x * x);
      slope = -4.0 * (1.0 - x * x) / (faded * faded * tilt * tilt) * s;
    }
  };

  /// Returns the share if the corner is the nearest point without tilt, else 0. There the slope
  /// pulls on nothing: the force is along the normal.
  [[nodiscard]] double note_nearest(const Planar& r, double share) noexcept {
    if (!is_exact_ || dot(r, r) > at_nearest * at_nearest) return 0.0;
    held_ += share;
    return share;
  }

  void pull_at(const Planar& r, const Planar& t) noexcept {
    pull_ = pull_ + t;
    drill_ += cross(r, t);
    x_pull_ = x_pull_ + r.x * t;
    y_pull_ = y_pull_ + r.y * t;
  }

  /// K and L at z, with w distributed as a coordinate on a disc of radius 1:
  /// K = E[max(0, z + w)] and L = E[max(0, z + w)^2] / 2.
  struct Excess {
    double share, first, second;  ///< P(z + w > 0), K, L

    explicit Excess(double z) noexcept {
      if (z >= 1.0) {
        share = 1.0;
        first = z;
        second = 0.5 * (z * z + 0.25);
      } else if (z <= -1.0) {
        share = first = second = 0.0;
      } else {
        const double half = std::sqrt(1.0 - z * z);
        const double angle = std::asin(z);
        const double mean = 2.0 / (3.0 * std::numbers::pi) * half * half * half;
        const double spread =
            0.125 + (angle - z * half * (1.0 - 2.0 * z * z)) / (4.0 * std::numbers::pi);
        share = 0.5 + (z * half + angle) / std::numbers::pi;
        first = z * share + mean;
        second = 0.5 * (z * z * share + 2.0 * z * mean + spread);
      }
    }
  };

  /// With the coordinate x along the segment, the minimum over it of c x^2 / 2 - (s + theta) x.
  void average_segment(const Outline& outline) noexcept {
    const Outline::Corner from = outline.at(0);
    const Outline::Corner to = outline.at(1);
    const Planar edge = to.r - from.r;
    const double length = norm(edge);
    const Planar along = (1.0 / length) * edge;
    const double s = dot(s_, along);
    const double low = dot(along, from.r);
    const double c = outline.bend;
    const Excess first((s - c * low) / e_);
    const Excess last((s - c * (low + length)) / e_);
    const double width = c * length / e_;
    // Differences divided by `width`; where it is small, derivatives within.
    double once = 0.0;
    double twice = 0.0;
    double thrice = 0.0;
    if (width < 1e-4) {
      const Excess middle((s - c * (low + 0.5 * length)) / e_);
      once = middle.share;
      twice = middle.first;
      thrice = 0.5 * middle.share;
    } else {
      once = (first.first - last.first) / width;
      twice = (first.second - last.second) / width;
      thrice = (twice - last.first) / width;
    }
    point_ = from.r + once * edge;
    square_ = low * low + 2.0 * length * (low * once + length * thrice);
    const Planar aside = from.r - low * along;
    nearer_ = dot(s_, aside) + low * (s - 0.5 * c * low) + e_ * length * twice;
    widened_ = length * (2.0 * twice - (s - c * low) / e_ * once - last.first);
    const double at_end = note_nearest(to.r, last.share);
    const double at_start = note_nearest(from.r, 1.0 - first.share);
    const double beyond_end = e_ * last.first - at_end * s;
    const double beyond_start = e_ * first.first - s + c * low + at_start * s;
    const auto part_of_a = [&](const Outline::Corner& end, double held) {
      const bool of_both = held > 0.0 && outline.touching_a > 0 && outline.touching_b > 0;
      return of_both ? 0.5 : (end.of_a ? 1.0 : 0.0);
    };
    pull_at(to.r, -part_of_a(to, at_end) * beyond_end * along);
    pull_at(from.r, part_of_a(from, at_start) * beyond_start * along);
  }

  /// The borders between the cones of two corners: the rays along the outward normals of the sides.
  struct Rays {
    Sides::Numbers share;   ///< of the disc, from a fixed ray to this one, counter-clockwise
    Sides::Numbers moment;  ///< half the integral of e^2 - |y - s|^2 along it, over the disc's area
  };

  [[nodiscard]] Rays find_rays(int size, const Sides& sides) const noexcept {
    const bool is_inside = dot(s_, s_) < e_ * e_;
    const double of_area = 1.0 / (std::numbers::pi * e_ * e_);
    const Lanes none{};
    Rays rays;
    for (int i = 0; i < size; i += lane_count) {
      const Lanes x = Sides::some(sides.normal_x, i);
      const Lanes y = Sides::some(sides.normal_y, i);
      const Lanes b = s_.x * x + s_.y * y;
      const Lanes h = x * s_.y - y * s_.x;
      const Lanes half = roots(larger(e_ * e_ - h * h, none));
      if (is_inside) {
        const Lanes out = b + half;
        const Lanes turn = turns_of(out * y - s_.y, out * x - s_.x);
        Sides::store(rays.share, i, 0.5 * of_area * (e_ * e_ * turn - out * h));
        Sides::store(rays.moment, i,
                     0.5 * of_area * (half * half * out - (half * half * half + b * b * b) / 3.0));
        continue;
      }
      // The share clockwise of the ray: of the disc beyond a line at -h.
      const Lanes within = 0.5 + of_area * (e_ * e_ * turns_of(-h, half) - h * half);
      const Lanes beside = either(h > 0.0, none, all_of(1.0));
      Sides::store(rays.share, i, either((b > 0.0) & (half > 0.0), within, beside));
      Sides::store(rays.moment, i, either(b > 0.0, 2.0 / 3.0 * of_area * half * half * half, none));
    }
    return rays;
  }

  void average_polygon(const Outline& outline, const Sides& sides) noexcept {
    const Rays rays = find_rays(outline.size, sides);
    // By Cauchy's formula, H(0) is the perimeter times this.
    const double flat = e_ / (3.0 * std::numbers::pi);
    double perimeter = 0.0;
    for (int i = 0; i < outline.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      nearer_ += rays.moment[k] * sides.length[k];
      perimeter += sides.length[k];
    }
    nearer_ -= fade_.share * flat * perimeter;
    for (int i = 0; i < outline.size; ++i) average_corner(outline, sides, rays, flat, i);
    nearer_ += dot(s_, point_);
    point_ = point_ - flat * perimeter * fade_.slope;
  }

  void average_corner(const Outline& outline, const Sides& sides, const Rays& rays, double flat,
                      int i) noexcept {
    const int before = i > 0 ? i - 1 : outline.size - 1;
    const auto from = static_cast<std::size_t>(before);
    const auto to = static_cast<std::size_t>(i);
    double share = rays.share[to] - rays.share[from];
    if (share < -1e-9) share += 1.0;
    const Outline::Corner corner = outline.at(i);
    point_ = point_ + share * corner.r;
    const double held = note_nearest(corner.r, share);
    bool from_a = outline.at(before).of_a;
    bool to_a = corner.of_a;
    double part = 1.0;
    if (held > 0.0 && outline.touching_a > 0 && outline.touching_b > 0) {
      // With more than a side of each at a corner, rounding decides on the two found.
      if (outline.touching_a + outline.touching_b > 2 || from_a == to_a) {
        from_a = to_a = true;
        part = 0.5;
      }
    }
    if (!from_a && !to_a) return;
    // The mean of y over the cone.
    const auto turned = [](const Planar& n) { return Planar{-n.y, n.x}; };
    const double lessened = fade_.share * flat;
    const Planar normal_from = sides.normal(before);
    const Planar normal_to = sides.normal(i);
    const Planar y = (share - held) * s_ + (rays.moment[from] - lessened) * turned(normal_from) -
                     (rays.moment[to] - lessened) * turned(normal_to);
    if (from_a && to_a) return pull_at(corner.r, -part * y);
    const double sine = cross(normal_from, normal_to);
    const double most = 4.0 * norm(y);
    const double multiple = from_a ? cross(y, normal_to) : cross(normal_from, y);
    pull_at(corner.r, -std::clamp(multiple / std::max(sine, 1e-12), -most, most) *
                          (from_a ? normal_from : normal_to));
  }

  static constexpr double at_nearest = 1e-7;  ///< [m] from r = 0

  bool is_exact_;
  Planar s_;
  double e_;
  Fade fade_;
  double nearer_ = 0.0;
  Planar point_{};
  Planar pull_{};
  double drill_ = 0.0;
  double held_ = 0.0;
  double square_ = 0.0;
  double widened_ = 0.0;
  Planar x_pull_{}, y_pull_{};  ///< [m] sums of r.x t and r.y t
};

/// [rad] Features count as flat within this angle of the tangent plane. It exceeds the tilt, so
/// they come and go with weight zero.
[[nodiscard]] inline double flat_within(double tilt) noexcept {
  return TiltMean::faded * tilt;
}

/// By how much of an angle `tilt_beside` grows.
inline constexpr double tilt_growth = 0.045;
/// [rad] The tilt that a face leaves around a direction.
/// @param room [rad] Faces::room_of
/// @param off [rad] from its normal to the direction
[[nodiscard]] inline double tilt_beside(double room, double off) noexcept {
  return room + tilt_growth * off;
}

}  // namespace repel::detail
