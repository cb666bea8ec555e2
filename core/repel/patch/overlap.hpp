/// @file
/// The overlap of two flat features, seen along their common normal.
#pragma once

#include <repel/patch/flat.hpp>
#include <repel/patch/plane.hpp>

namespace repel::detail {

/// `outline` cut by a line: what lies beyond it is removed.
/// @param normal unit, outward; `offset` [m]; points with normal.r <= offset stay
/// @param of_a whom the line belongs to
inline void cut(Outline& outline, const Planar& normal, double offset, bool of_a) noexcept {
  const auto beyond = [&](const Planar& r) { return dot(normal, r) - offset; };
  const auto crossing = [&](const Planar& from, const Planar& to) {
    const double start = beyond(from);
    return from + (start / (start - beyond(to))) * (to - from);
  };
  if (outline.size == 2) {
    const Planar from = outline.at(0).r;
    const Planar to = outline.at(1).r;
    const double first = beyond(from);
    const double last = beyond(to);
    if (first > 0.0 && last > 0.0) {
      outline.size = 0;
    } else if (first > 0.0) {
      outline.corners[0] = {crossing(from, to), of_a};
    } else if (last > 0.0) {
      outline.corners[1] = {crossing(from, to), of_a};
    }
    return;
  }
  bool is_cut = false;
  for (int i = 0; i < outline.size; ++i) is_cut = is_cut || beyond(outline.at(i).r) > 0.0;
  if (!is_cut) return;
  const Outline whole = outline;
  outline.size = 0;
  for (int i = 0; i < whole.size; ++i) {
    const Outline::Corner& here = whole.at(i);
    const Outline::Corner& next = whole.after(i);
    const bool here_out = beyond(here.r) > 0.0;
    const bool next_out = beyond(next.r) > 0.0;
    if (!here_out) outline.add(here.r, here.of_a);
    if (here_out == next_out) continue;
    // Leaving, the side to the next corner is the line; entering, the rest of the side.
    outline.add(crossing(here.r, next.r), next_out ? of_a : here.of_a);
  }
}

/// The corners of `outline` that differ from the one before by more than `least` [m].
inline void remove_short_sides(Outline& outline, double least) noexcept {
  const Outline whole = outline;
  outline.size = 0;
  for (int i = 0; i < whole.size; ++i) {
    if (norm(whole.after(i).r - whole.at(i).r) > least) {
      outline.add(whole.at(i).r, whole.at(i).of_a);
    }
  }
}

/// The segment along the bisector of two nearly parallel ones in which both lie.
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

/// Where the two features lie over each other; the nearest points are at r = 0.
/// @param holds_nearest keep r = 0, which rounding, or a normal between those of the features, may
/// leave outside: of shapes that are apart
/// @return false when that is a point
[[nodiscard]] inline bool find_overlap(const PlanarAxes& axes, const Flat& a,
                                       const Vec<double>& nearest_a, const Flat& b,
                                       const Vec<double>& nearest_b, bool holds_nearest,
                                       Outline& outline) noexcept {
  const auto outlined = [&](const Flat& flat, const Vec<double>& nearest, bool of_a) {
    Outline all;
    for (int i = 0; i < flat.size; ++i) all.add(axes.in_plane(flat.at(i) - nearest), of_a);
    if (all.size < 3) return all;
    double area = 0.0;
    for (int i = 0; i < all.size; ++i) area += cross(all.at(i).r, all.after(i).r);
    if (area < 0.0) std::reverse(all.corners.begin(), all.corners.begin() + all.size);
    return all;
  };
  constexpr double least = 1e-9;
  constexpr double touching = 1e-7;
  const auto count_touching = [](const Outline& other) {
    int count = 0;
    for (int i = 0; i < other.size; ++i) {
      const Planar& r = other.at(i).r;
      const Planar edge = other.after(i).r - r;
      const double off = other.size == 2 ? norm(r) : std::abs(cross(edge, r)) / norm(edge);
      count += off < touching ? 1 : 0;
    }
    return count;
  };
  const Outline first = outlined(a, nearest_a, true);
  const Outline second = outlined(b, nearest_b, false);
  const auto cut_by = [&](const Outline& other) {
    for (int i = 0; i < other.size; ++i) {
      const Planar edge = other.after(i).r - other.at(i).r;
      const double length = norm(edge);
      const Planar normal = (1.0 / length) * Planar{edge.y, -edge.x};
      const double offset = dot(normal, other.at(i).r);
      cut(outline, normal, (holds_nearest ? std::max(0.0, offset) : offset) + least,
          other.at(i).of_a);
    }
  };
  if (first.size > 2 && second.size == 2) {
    outline = second;
    cut_by(first);
  } else if (first.size == 2 && second.size == 2) {
    outline = common_segment(first, second);
  } else {
    outline = first;
    cut_by(second);
  }
  remove_short_sides(outline, touching);
  outline.touching_a = count_touching(first);
  outline.touching_b = count_touching(second);
  return outline.size >= 2;
}

}  // namespace repel::detail
