// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The overlap of two flat features, seen along their common normal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <repel/contact/plane.hpp>

namespace repel::detail {

/// `segment` cut by a line, as `cut`.
inline void cut_segment(Outline& segment, const Planar& normal, double offset, bool of_a) noexcept {
  const Planar from = segment.at(0).r;
  const Planar to = segment.at(1).r;
  const double first = dot(normal, from) - offset;
  const double last = dot(normal, to) - offset;
  if (first > 0.0 && last > 0.0) {
    segment.size = 0;
  } else if (first > 0.0) {
    segment.set(0, {from + (first / (first - last)) * (to - from), of_a});
  } else if (last > 0.0) {
    segment.set(1, {from + (first / (first - last)) * (to - from), of_a});
  }
}

/// The part of `polygon` within a line goes to `rest`.
/// @param normal outward, of any length; points with normal.r <= offset stay
/// @param of_a the line is of A
/// @return false, and `rest` is unchanged, if all of it stays
[[nodiscard]] inline bool cut(const Outline& polygon, const Planar& normal, double offset,
                              bool of_a, Outline& rest) noexcept {
  std::array<double, Outline::most> beyond;
  bool is_cut = false;
  for (int i = 0; i < polygon.size; ++i) {
    const double by = dot(normal, polygon.at(i).r) - offset;
    is_cut = is_cut || by > 0.0;
    beyond[static_cast<std::size_t>(i)] = by;
  }
  if (!is_cut) return false;
  rest.size = 0;
  int next = polygon.size > 1 ? 1 : 0;
  double here_by = beyond[0];
  for (int i = 0; i < polygon.size; ++i) {
    const double next_by = beyond[static_cast<std::size_t>(next)];
    const Outline::Corner here = polygon.at(i);
    if (!(here_by > 0.0)) rest.add(here.r, here.of_a);
    if ((here_by > 0.0) != (next_by > 0.0)) {
      // Leaving, the side to the next corner is the line; entering, the rest of the side.
      rest.add(here.r + (here_by / (here_by - next_by)) * (polygon.at(next).r - here.r),
               next_by > 0.0 ? of_a : here.of_a);
    }
    here_by = next_by;
    next = next + 1 < polygon.size ? next + 1 : 0;
  }
  return true;
}

/// The corners of a polygon, but for those nearer than `least` [m] to the next.
inline void remove_short_sides(Outline& polygon, const Sides& sides, double least) noexcept {
  const Outline whole = polygon;
  polygon.size = 0;
  for (int i = 0; i < whole.size; ++i) {
    if (sides.length[static_cast<std::size_t>(i)] > least) {
      polygon.add(whole.at(i).r, whole.at(i).of_a);
    }
  }
}

/// The segment along the bisector of two nearly parallel ones, containing both.
[[nodiscard]] inline Outline common_segment(const Outline& first, const Outline& second) noexcept {
  const auto unit_along = [](const Outline& segment) {
    const Planar edge = segment.at(1).r - segment.at(0).r;
    return (1.0 / norm(edge)) * edge;
  };
  const Planar u = unit_along(first);
  const Planar v = unit_along(second);
  const Planar middle = dot(u, v) < 0.0 ? u - v : u + v;
  const Planar along = (1.0 / norm(middle)) * middle;
  const auto extent = [&](const Outline& segment) {
    const double from = dot(along, segment.at(0).r);
    const double to = dot(along, segment.at(1).r);
    return std::pair(std::min(0.0, std::min(from, to)), std::max(0.0, std::max(from, to)));
  };
  const auto [low_a, high_a] = extent(first);
  const auto [low_b, high_b] = extent(second);
  Outline common;
  common.add(std::max(low_a, low_b) * along, low_a > low_b);
  common.add(std::min(high_a, high_b) * along, high_a < high_b);
  return common;
}

/// Whether a side, or the end of a segment, passes through r = 0.
[[nodiscard]] inline bool is_touching(const Planar& from, const Planar& edge, int size) noexcept {
  constexpr double touching = 1e-14;  // [m^2]
  if (size == 2) return dot(from, from) < touching;
  const double off = cross(edge, from);
  return off * off < touching * dot(edge, edge);
}
[[nodiscard]] inline int count_touching(const Outline& outline) noexcept {
  int count = 0;
  for (int i = 0; i < outline.size; ++i) {
    const Planar from = outline.at(i).r;
    count += is_touching(from, outline.after(i).r - from, outline.size) ? 1 : 0;
  }
  return count;
}

/// `outline` cut by all sides of a polygon. The nearest points are at r = 0.
/// @param holds_nearest keep r = 0
inline void cut_by(const Outline& polygon, bool holds_nearest, Outline& outline) noexcept {
  constexpr double least = 1e-9;  // [m] rounding error
  Outline other;
  Outline* whole = &outline;
  Outline* rest = &other;
  for (int i = 0; i < polygon.size; ++i) {
    const Outline::Corner from = polygon.at(i);
    const Planar edge = polygon.after(i).r - from.r;
    const Planar normal{edge.y, -edge.x};
    const double off = dot(normal, from.r);
    const double offset = (holds_nearest ? std::max(0.0, off) : off) + least * norm(edge);
    if (outline.size == 2) {
      cut_segment(outline, normal, offset, from.of_a);
    } else if (cut(*whole, normal, offset, from.of_a, *rest)) {
      std::swap(whole, rest);
    }
  }
  if (whole != &outline) outline = *whole;
}

/// Where two features lie over each other; the nearest points are at r = 0.
/// @param holds_nearest keep r = 0 for separated shapes: rounding, or a normal between those of the
/// features, may leave it outside
/// @param overlap,sides the result, and its sides of 0.1 um or more
/// @return false for a point
[[nodiscard]] inline bool find_overlap(const Outline& a, const Outline& b, bool holds_nearest,
                                       Outline& overlap, Sides& sides) noexcept {
  constexpr double shortest = 1e-7;
  if (a.size > 2 && b.size == 2) {
    overlap = b;
    cut_by(a, holds_nearest, overlap);
  } else if (a.size == 2 && b.size == 2) {
    overlap = common_segment(a, b);
  } else {
    overlap = a;
    cut_by(b, holds_nearest, overlap);
  }
  if (overlap.size < 2) return false;
  overlap.touching_a = count_touching(a);
  overlap.touching_b = count_touching(b);
  sides.find(overlap);
  if (sides.least_length(overlap.size) > shortest) return true;
  remove_short_sides(overlap, sides, shortest);
  sides.find(overlap);
  return overlap.size >= 2;
}

}  // namespace repel::detail
