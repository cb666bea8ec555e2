// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// TiltMean over the overlaps of several pairs of polygons at once, one pair per SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include <repel/contact/polygon_lanes.hpp>
#include <repel/contact/tilt_mean.hpp>
#include <repel/contact/turn.hpp>

namespace repel::detail {

/// TiltMean for polygons of that many sides, with their overlap.
template <std::size_t sides>
class PolygonMean {
 public:
  /// @param slope s; `tilt` e [rad] and `off` as in TiltMean
  PolygonMean(const PolygonLanes& a, const PolygonLanes& b, const PlanarLanes& slope,
              const Lanes& tilt, const Lanes& off) noexcept
      : s_(slope), e_(tilt) {
    const Lanes x = larger(roots(dot(s_, s_)), off) / (TiltMean::faded * e_);
    const Lanes left = larger(1.0 - x * x, Lanes{});
    of_area_ = 1.0 / (std::numbers::pi * e_ * e_);
    flat_ = (1.0 / (3.0 * std::numbers::pi)) * e_;
    share_ = left * left;
    fall_ = (-4.0 / (TiltMean::faded * TiltMean::faded)) * left / (e_ * e_);
    for (std::size_t i = 0; i < sides; ++i) set(a, i, sides_a_[i]);
    for (std::size_t j = 0; j < sides; ++j) set(b, j, sides_b_[j]);
    for (std::size_t i = 0; i < sides; ++i) join(sides_a_, i);
    for (std::size_t j = 0; j < sides; ++j) {
      join(sides_b_, j);
      grow(j);
    }
    for (std::size_t i = 0; i < sides; ++i) {
      for (std::size_t j = 0; j < sides; ++j) cut(sides_a_[i], sides_b_[j]);
    }
    for (std::size_t i = 0; i < sides; ++i) add_of_a(sides_a_[i]);
    for (std::size_t j = 0; j < sides; ++j) add(sides_b_[j]);
    finish();
  }

  /// As those of TiltMean.
  [[nodiscard]] const Lanes& nearer() const noexcept { return nearer_; }
  [[nodiscard]] const PlanarLanes& point() const noexcept { return point_; }
  [[nodiscard]] const PlanarLanes& pull() const noexcept { return pull_; }
  [[nodiscard]] const Lanes& held() const noexcept { return held_; }
  [[nodiscard]] const Lanes& drill() const noexcept { return drill_; }
  [[nodiscard]] PlanarLanes lifted(const PlanarLanes& slope_of_a) const noexcept {
    return slope_of_a.x * x_pull_ + slope_of_a.y * y_pull_;
  }
  /// `farthest_along` the slope.
  [[nodiscard]] const Lanes& farthest() const noexcept { return farthest_; }
  /// False if rounding decides the bounds of the overlap, and for a degenerate overlap.
  [[nodiscard]] const LaneMask& is_sure() const noexcept { return is_sure_; }

 private:
  /// The outward normal of a side and its ray, as in TiltMean.
  struct Ray {
    PlanarLanes normal;
    Lanes share, moment;
    Lanes across;  ///< cross(normal, s)
  };
  struct Side {
    PlanarLanes from;  ///< [m] its first corner
    Lanes length;      ///< [m]
    Lanes offset;      ///< [m] of its line, normal.r = offset
    Ray ray;
    Lanes begin, end;   ///< [m] the remaining part of it, from the first corner
    Ray before, after;  ///< of the sides at its begin and end

    [[nodiscard]] PlanarLanes at(const Lanes& t) const noexcept {
      return {from.x - t * ray.normal.y, from.y + t * ray.normal.x};
    }
  };
  using All = std::array<Side, sides>;

  static Ray chosen(const LaneMask& first, const Ray& a, const Ray& b) noexcept {
    return {either(first, a.normal, b.normal), either(first, a.share, b.share),
            either(first, a.moment, b.moment), either(first, a.across, b.across)};
  }

  void set(const PolygonLanes& polygon, std::size_t i, Side& side) noexcept {
    side.from = polygon.corners[i];
    const PlanarLanes along = polygon.corners[i + 1 < sides ? i + 1 : 0] - side.from;
    side.length = roots(dot(along, along));
    const Lanes part = 1.0 / side.length;
    side.ray.normal = {part * along.y, -part * along.x};
    side.offset = dot(side.ray.normal, side.from);
    find(side.ray);
  }

  /// TiltMean::find_rays.
  void find(Ray& ray) const noexcept {
    const Lanes none{};
    const auto& [x, y] = ray.normal;
    const Lanes b = dot(s_, ray.normal);
    const Lanes h = cross(ray.normal, s_);
    const Lanes square = larger(e_ * e_ - h * h, none);
    const Lanes half = roots(square);
    const LaneMask is_inside = dot(s_, s_) < e_ * e_;
    const Lanes out = b + half;
    const Lanes turn =
        turns_of(either(is_inside, out * y - s_.y, -h), either(is_inside, out * x - s_.x, half));
    const Lanes sector = e_ * e_ * turn;
    const Lanes cube = square * half;
    const Lanes within = 0.5 + of_area_ * (sector - h * half);
    const Lanes beside = either(h > none, none, all_of(1.0));
    const LaneMask meets = (b > none) & (half > none);
    ray.share =
        either(is_inside, 0.5 * of_area_ * (sector - out * h), either(meets, within, beside));
    const Lanes moment = 0.5 * of_area_ * (square * out - (1.0 / 3.0) * (cube + b * b * b));
    ray.moment = either(is_inside, moment, either(b > none, (2.0 / 3.0) * of_area_ * cube, none));
    ray.moment = ray.moment - share_ * flat_;
    ray.across = h;
  }

  static void join(All& all, std::size_t i) noexcept {
    Side& side = all[i];
    side.begin = Lanes{};
    side.end = side.length;
    side.before = all[i > 0 ? i - 1 : sides - 1].ray;
    side.after = all[i + 1 < sides ? i + 1 : 0].ray;
  }

  /// Moves a side of B outward by the rounding error, as cut_by does.
  void grow(std::size_t j) noexcept {
    Side& side = sides_b_[j];
    const Lanes none{};
    touching_b_ = touching_b_ + either(magnitudes(side.offset) < touching, all_of(1.0), none);
    lowest_ = smaller(lowest_, side.offset);
    const PlanarLanes& n = side.ray.normal;
    const auto tangent_of_half = [](const PlanarLanes& from, const PlanarLanes& to) {
      return cross(from, to) / (1.0 + dot(from, to));
    };
    const Lanes back = least * tangent_of_half(side.before.normal, n);
    side.end = side.end + back + least * tangent_of_half(n, side.after.normal);
    side.from = side.at(-back) + all_of(least) * n;
    side.offset = side.offset + least;
  }

  static void cut(Side& a, Side& b) noexcept {
    const Lanes none{};
    const Lanes sine = cross(a.ray.normal, b.ray.normal);
    const Lanes inverse = 1.0 / either(sine == none, all_of(1e-30), sine);
    const Lanes at_a = inverse * (b.offset - dot(b.ray.normal, a.from));
    const Lanes at_b = inverse * (dot(a.ray.normal, b.from) - a.offset);
    const LaneMask leaves = sine >= none;  // also along it
    const LaneMask ends = leaves & (at_a < a.end);
    const LaneMask begins = ~leaves & (at_a > a.begin);
    a.end = either(ends, at_a, a.end);
    a.after = chosen(ends, b.ray, a.after);
    a.begin = either(begins, at_a, a.begin);
    a.before = chosen(begins, b.ray, a.before);
    const LaneMask enters = leaves & (at_b > b.begin);
    b.begin = either(enters, at_b, b.begin);
    b.before.share = either(enters, a.ray.share, b.before.share);
    b.end = either(~leaves & (at_b < b.end), at_b, b.end);
  }

  struct Corner {
    PlanarLanes r;
    Lanes share;
    LaneMask is_nearest;
  };
  [[nodiscard]] Corner corner(const Side& side, const Lanes& t, const Ray& from,
                              const Ray& to) const noexcept {
    const Lanes share = to.share - from.share;
    const PlanarLanes r = side.at(t);
    return {r, either(share < -1e-9, share + 1.0, share),
            dot(r, r) <= all_of(at_nearest * at_nearest)};
  }

  Corner add(const Side& side) noexcept {
    const Lanes none{};
    const LaneMask is_left = side.end > side.begin;
    const Lanes length = either(is_left, side.end - side.begin, none);
    Corner start = corner(side, side.begin, side.before, side.ray);
    const Lanes share = either(is_left, start.share, none);
    const PlanarLanes r = either(is_left, start.r, {none, none});
    point_ = point_ + share * r;
    shares_ = shares_ + share;
    held_ = held_ + either(start.is_nearest, share, none);
    nearer_ = nearer_ + side.ray.moment * length;
    perimeter_ = perimeter_ + length;
    closing_ = closing_ + length * side.ray.normal;
    const Lanes far = dot(s_, start.r);
    farthest_ = either(is_left & (far > farthest_), far, farthest_);
    return start;
  }

  /// The multiple of the normal of a side of A in the mean y over the cone of a corner.
  /// @param one of the side, `other` of the one beside it, both around the corner
  /// @param across of the other, positive where the side of A comes second
  [[nodiscard]] Lanes multiple(const Ray& one, const Ray& other, const Lanes& sine,
                               const Lanes& across, const Lanes& share,
                               const LaneMask& is_own) const noexcept {
    const Lanes none{};
    const Lanes cosine = dot(one.normal, other.normal);
    const Lanes wanted = share * across + other.moment - cosine * one.moment;
    const Lanes found = wanted / larger(sine, all_of(1e-12));
    if (bits_of(sine < all_of(0.25)) == 0U) return found;
    // y in the axes of the other normal; its size bounds the multiple.
    const Lanes away = share * dot(s_, other.normal) + one.moment * sine;
    const Lanes most = 4.0 * roots(wanted * wanted + away * away);
    return either(sine > 1e-9, either(is_own, found, smaller(larger(found, -most), most)), none);
  }

  void add_of_a(const Side& side) noexcept {
    const Lanes none{};
    touching_a_ = touching_a_ + either(magnitudes(side.offset) < touching, all_of(1.0), none);
    const Corner start = add(side);
    const Corner end = corner(side, side.end, side.ray, side.after);
    const Ray& ray = side.ray;
    const auto moving = [&](const Corner& c) { return either(c.is_nearest, none, c.share); };
    const Lanes first = multiple(ray, side.before, cross(side.before.normal, ray.normal),
                                 side.before.across, moving(start), side.begin == none);
    const Lanes last = multiple(ray, side.after, cross(ray.normal, side.after.normal),
                                -side.after.across, moving(end), side.end == side.length);
    const LaneMask is_left = side.end > side.begin;
    const Lanes by_first = either(is_left, first, none);
    const Lanes by_last = either(is_left, last, none);
    const PlanarLanes moment = either(is_left, by_first * start.r + by_last * end.r, {none, none});
    pull_ = pull_ - (by_first + by_last) * ray.normal;
    drill_ = drill_ - cross(moment, ray.normal);
    x_pull_ = x_pull_ - moment.x * ray.normal;
    y_pull_ = y_pull_ - moment.y * ray.normal;
  }

  void finish() noexcept {
    nearer_ = nearer_ + dot(s_, point_);
    point_ = point_ - flat_ * perimeter_ * fall_ * s_;
    const Lanes none{};
    const LaneMask is_closed = (magnitudes(closing_.x) < 1e-8) & (magnitudes(closing_.y) < 1e-8) &
                               (magnitudes(shares_ - 1.0) < 1e-6) & (perimeter_ > 1e-6);
    const LaneMask is_plain =
        (touching_a_ == none) | (touching_b_ == none) | (touching_a_ + touching_b_ < 2.5);
    is_sure_ = is_closed & is_plain & (lowest_ > -least);
  }

  static constexpr double least = 1e-9;       ///< [m] see cut_by
  static constexpr double touching = 1e-7;    ///< [m] see is_touching
  static constexpr double at_nearest = 1e-7;  ///< [m] from r = 0

  PlanarLanes s_;
  Lanes e_;
  Lanes of_area_, flat_;
  Lanes share_, fall_;  ///< as TiltMean::Fade
  All sides_a_, sides_b_;
  Lanes nearer_{};
  PlanarLanes point_{};
  PlanarLanes pull_{};
  Lanes drill_{}, held_{};
  PlanarLanes x_pull_{}, y_pull_{};
  Lanes farthest_ = all_of(-1e300);
  Lanes shares_{}, perimeter_{};
  PlanarLanes closing_{};
  Lanes touching_a_{}, touching_b_{};
  Lanes lowest_{};  ///< [m] negative where r = 0 is outside of B
  LaneMask is_sure_{};
};

}  // namespace repel::detail
