// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vectors and convex polygons in the tangent plane of a contact.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <repel/base/lanes.hpp>
#include <repel/base/vec.hpp>

namespace repel::detail {

/// A vector in the tangent plane. `Planar v;` leaves it uninitialized, `Planar{}` is zero.
struct Planar {
  double x, y;

  friend Planar operator+(const Planar& a, const Planar& b) noexcept {
    return {a.x + b.x, a.y + b.y};
  }
  friend Planar operator-(const Planar& a, const Planar& b) noexcept {
    return {a.x - b.x, a.y - b.y};
  }
  friend Planar operator*(double s, const Planar& a) noexcept { return {s * a.x, s * a.y}; }
  friend double dot(const Planar& a, const Planar& b) noexcept { return a.x * b.x + a.y * b.y; }
  /// Positive when b is counter-clockwise of a.
  friend double cross(const Planar& a, const Planar& b) noexcept { return a.x * b.y - a.y * b.x; }
  friend double norm(const Planar& a) noexcept { return std::sqrt(dot(a, a)); }
};

/// Right-handed axes of the tangent plane with the unit normal n.
struct PlanarAxes {
  Vec<double> n, e1, e2;  ///< unit, world axes

  explicit PlanarAxes(const Vec<double>& normal) noexcept : n(normal) {
    const Vec<double> far =
        std::abs(n.z()) < 0.7 ? Vec<double>(0.0, 0.0, 1.0) : Vec<double>(1.0, 0.0, 0.0);
    const Vec<double> side = cross(far, n);
    e1 = (1.0 / std::sqrt(dot(side, side))) * side;
    e2 = cross(n, e1);
  }
  [[nodiscard]] Planar in_plane(const Vec<double>& v) const noexcept {
    return {dot(e1, v), dot(e2, v)};
  }
  [[nodiscard]] Vec<double> in_world(const Planar& v) const noexcept { return v.x * e1 + v.y * e2; }
};

/// A convex polygon, counter-clockwise, or a segment with two corners. What bounds it belongs to
/// one of two bodies: a side of a polygon, an end of a segment.
class Outline {
 public:
  static constexpr int most = 32;

  struct Corner {
    Planar r;   ///< [m]
    bool of_a;  ///< A bounds it: along the side to the next corner, or at this end
  };
  int size = 0;
  /// How many sides, or ends, of A and B pass through r = 0.
  int touching_a = 0;
  int touching_b = 0;
  bool is_exact = true;  ///< the point r = 0 is known to rounding: no curve was searched for it
  double bend = 0.0;     ///< [1/m] of a segment: the second derivative of the gap along it

  Outline() = default;
  Outline(const Outline& other) noexcept { *this = other; }
  /// Copies the corners that are set.
  Outline& operator=(const Outline& other) noexcept {
    for (std::size_t i = 0; i < static_cast<std::size_t>(other.size); ++i) {
      x_[i] = other.x_[i];
      y_[i] = other.y_[i];
    }
    of_a_ = other.of_a_;
    size = other.size;
    touching_a = other.touching_a;
    touching_b = other.touching_b;
    is_exact = other.is_exact;
    bend = other.bend;
    return *this;
  }

  void add(const Planar& r, bool of_a) noexcept {
    if (size < most) set(size++, {r, of_a});
  }
  void set(int i, const Corner& corner) noexcept {
    x_[static_cast<std::size_t>(i)] = corner.r.x;
    y_[static_cast<std::size_t>(i)] = corner.r.y;
    const std::uint32_t bit = std::uint32_t{1} << i;
    of_a_ = corner.of_a ? of_a_ | bit : of_a_ & ~bit;
  }
  [[nodiscard]] Corner at(int i) const noexcept {
    return {{x_[static_cast<std::size_t>(i)], y_[static_cast<std::size_t>(i)]},
            (of_a_ >> i & 1U) != 0U};
  }
  [[nodiscard]] Corner after(int i) const noexcept { return at(i + 1 < size ? i + 1 : 0); }

 private:
  std::array<double, most> x_, y_;  ///< only the first `size` are set
  std::uint32_t of_a_ = 0;
};

/// A flat feature as seen along the normal of a contact: a point, a segment, or a convex polygon,
/// counter-clockwise.
struct Flat {
  static constexpr int most = 16;  ///< corners

  Outline outline;               ///< of up to `most` corners, with the nearest point at r = 0
  Planar slope{};                ///< how its height along the normal changes; of a point 0
  bool is_disc = false;          ///< the polygon stands for a disc
  double radius = 0.0;           ///< [m] of a segment: of curvature across it
  double tilt = 0.0;             ///< [rad] up to which no other feature of the set is nearest
  std::uint32_t face = no_face;  ///< of a polytope: its name in the set

  static constexpr std::uint32_t no_face = 0xFFFFFFFFU;
};

/// Which side of a contact a set is on: below, and its outward normal along n, or above.
enum class Facing : std::int8_t { up = 1, down = -1 };

/// The sides of an outline.
struct Sides {
  using Numbers = std::array<double, Outline::most + lane_count>;  ///< one per side

  Numbers normal_x, normal_y;  ///< unit, outward
  Numbers length;              ///< [m]

  void find(const Outline& outline) noexcept {
    for (int i = 0; i < outline.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Planar along = outline.after(i).r - outline.at(i).r;
      length[k] = norm(along);
      const double part = 1.0 / length[k];
      normal_x[k] = part * along.y;
      normal_y[k] = -part * along.x;
    }
    // Whole registers are read: behind the last side, too, stands a number, and no operation on it
    // is invalid, also where a program has the processor stop at such.
    for (auto k = static_cast<std::size_t>(outline.size); k % lane_count != 0; ++k) {
      normal_x[k] = 1.0;
      normal_y[k] = 0.0;
    }
  }
  [[nodiscard]] Planar normal(int i) const noexcept {
    return {normal_x[static_cast<std::size_t>(i)], normal_y[static_cast<std::size_t>(i)]};
  }
  /// [m] The shortest of `size` sides.
  [[nodiscard]] double least_length(int size) const noexcept {
    return *std::min_element(length.begin(), length.begin() + size);
  }
  static void store(Numbers& numbers, int i, const Lanes& lanes) noexcept {
    std::memcpy(numbers.data() + i, &lanes, sizeof lanes);
  }
  [[nodiscard]] static Lanes some(const Numbers& numbers, int i) noexcept {
    Lanes lanes;
    std::memcpy(&lanes, numbers.data() + i, sizeof lanes);
    return lanes;
  }
};

}  // namespace repel::detail
