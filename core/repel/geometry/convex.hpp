/// @file
/// A convex set given by its support map: the farthest point of the set along a direction.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include <repel/base/vec.hpp>
#include <repel/geometry/support_table.hpp>
#include <repel/geometry/vertex_scan.hpp>

namespace repel {

/// One convex set around its own origin. A box with zero extents is a rectangle, a segment or a
/// point; a cylinder with zero half length is a disc. Points are addressed by a 32-bit name, so
/// that a simplex of them can be kept from tick to tick in a few bytes: corner signs for a box, the
/// vertex index for a polytope, side and angle (to 1e-8) for a cylinder.
class Convex {
 public:
  /// Up to so many vertices a scan of all of them is as fast as a table of directions.
  static constexpr std::size_t largest_scan = 32;

  enum class Kind : std::uint8_t { box, cylinder, polytope };

  struct Point {
    std::uint32_t name = 0;
    Vec<double> p;  ///< [m] in the frame of the set
  };

  /// Corners at +-`half_extents` [m], each at least 0.
  static Convex box(const Vec3& half_extents) {
    Convex set(Kind::box);
    set.size_ = Vec<double>(half_extents);
    set.reach_ = half_extents.norm();
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
      corners[i] = {(i & 1U) != 0U ? half_extents.x() : -half_extents.x(),
                    (i & 2U) != 0U ? half_extents.y() : -half_extents.y(),
                    (i & 4U) != 0U ? half_extents.z() : -half_extents.z()};
    }
    set.vertices_ = VertexScan(corners);
    set.thick_axes_ = (half_extents.x() > 0.0 ? 1U : 0U) | (half_extents.y() > 0.0 ? 2U : 0U) |
                      (half_extents.z() > 0.0 ? 4U : 0U);
    return set;
  }
  /// Around the z axis; `radius` and `half_length` [m] at least 0.
  static Convex cylinder(double radius, double half_length) {
    Convex set(Kind::cylinder);
    set.size_ = {radius, radius, half_length};
    set.reach_ = std::hypot(radius, half_length);
    return set;
  }
  /// The convex hull of at least one vertex [m].
  static Convex polytope(std::span<const Vec3> vertices) {
    Convex set(Kind::polytope);
    set.vertices_ = VertexScan(vertices);
    if (vertices.size() > largest_scan) set.table_ = SupportTable(vertices);
    for (const Vec3& v : vertices) set.reach_ = std::max(set.reach_, v.norm());
    return set;
  }

  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  /// [m] distance of the farthest point from the origin of the frame.
  [[nodiscard]] double reach() const noexcept { return reach_; }
  /// True when every point named is exactly representable, so that extended precision helps.
  [[nodiscard]] bool is_polytope() const noexcept {
    return kind_ != Kind::cylinder || size_.x() == 0.0;
  }
  /// Number of vertices; 0 for a set with a curved boundary.
  [[nodiscard]] int vertex_count() const noexcept;

  /// The farthest point along `d`, which need not be unit. T is double or DoubleDouble.
  template <class T>
  [[nodiscard]] Point support(const Vec<T>& d) const noexcept {
    switch (kind_) {
      case Kind::box:
        return box_support(d);
      case Kind::cylinder:
        return cylinder_support(d);
      case Kind::polytope:
        break;
    }
    const std::uint32_t i = table_.empty() ? vertices_.scan(d) : best_candidate(d);
    return {i, vertices_.vertex(i)};
  }

  /// The place alone of the point of that name [m].
  [[nodiscard]] Vec<double> place(std::uint32_t name) const noexcept {
    return kind_ == Kind::cylinder ? rim_point(name).p : vertices_.vertex(name);
  }

  /// The largest product of `d` with a point of the set [m] for unit `d`: what `support` reaches,
  /// without saying where.
  [[nodiscard]] double support_value(const Vec<double>& d) const noexcept {
    switch (kind_) {
      case Kind::box:
        return dot(size_, magnitudes(d));
      case Kind::cylinder:
        return size_.x() * std::sqrt(d.x() * d.x() + d.y() * d.y()) + size_.z() * std::abs(d.z());
      case Kind::polytope:
        break;
    }
    if (table_.empty()) return vertices_.largest_product(d);
    double largest = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : table_.candidates(d)) {
      largest = std::max(largest, dot(vertices_.vertex(i), d));
    }
    return largest;
  }

  /// The point of that name; any name gives some point of the set. Names carry over between a set
  /// and its reduced forms: the same corner, the same vertex, the same angle.
  [[nodiscard]] Point point(std::uint32_t name) const noexcept {
    switch (kind_) {
      case Kind::box:
        return box_corner(name);
      case Kind::cylinder:
        return rim_point(name);
      case Kind::polytope:
        break;
    }
    const std::uint32_t i = name < static_cast<std::uint32_t>(vertices_.size()) ? name : 0U;
    return {i, vertices_.vertex(i)};
  }

 private:
  explicit Convex(Kind kind) noexcept : kind_(kind) {}

  template <class T>
  [[nodiscard]] Point box_support(const Vec<T>& d) const noexcept {
    const T zero(0.0);
    const unsigned name =
        (d.x() > zero ? 1U : 0U) | (d.y() > zero ? 2U : 0U) | (d.z() > zero ? 4U : 0U);
    return box_corner(name);
  }

  // A corner of a flat box has several names; the lowest stands for all.
  [[nodiscard]] Point box_corner(std::uint32_t name) const noexcept {
    name &= thick_axes_;
    return {name, vertices_.vertex(name)};
  }

  // The candidates hold the vertex that a scan of all of them would find.
  template <class T>
  [[nodiscard]] std::uint32_t best_candidate(const Vec<T>& d) const noexcept {
    const auto candidates = table_.candidates(Vec<double>(d));
    std::uint32_t winner = candidates.front();
    T best = dot(Vec<T>(vertices_.vertex(winner)), d);
    for (const std::uint32_t i : candidates.subspan(1)) {
      const T along = dot(Vec<T>(vertices_.vertex(i)), d);
      if (along > best) {
        best = along;
        winner = i;
      }
    }
    return winner;
  }

  template <class T>
  [[nodiscard]] Point cylinder_support(const Vec<T>& direction) const noexcept {
    const Vec3 d = to_vec3(direction);
    const double z = d.z() > 0.0 ? size_.z() : -size_.z();
    const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
    // Along the axis every point of the cap is farthest: its centre stands for all.
    if (!(across > 1e-300) || size_.x() == 0.0) return {name_of_rim(0.0, 0.0, z), {0.0, 0.0, z}};
    const double cosine = d.x() / across;
    const double sine = d.y() / across;
    return {name_of_rim(cosine, sine, z), {size_.x() * cosine, size_.x() * sine, z}};
  }

  // Name of a rim point: bit 31 the side, bit 30 set for the centre of the cap, bits 28 and 29 the
  // signs of cosine and sine, below them the tangent of half the angle within its quadrant.
  static constexpr double angle_steps = 268435455.0;  // 2^28 - 1

  [[nodiscard]] static std::uint32_t name_of_rim(double cosine, double sine, double z) noexcept {
    const std::uint32_t side = z > 0.0 ? 1U << 31U : 0U;
    if (cosine == 0.0 && sine == 0.0) return side | (1U << 30U);
    const double half_tangent = std::min(1.0, std::abs(sine) / (1.0 + std::abs(cosine)));
    return side | (cosine < 0.0 ? 1U << 28U : 0U) | (sine < 0.0 ? 1U << 29U : 0U) |
           static_cast<std::uint32_t>(half_tangent * (angle_steps - 1.0));
  }
  [[nodiscard]] Point rim_point(std::uint32_t name) const noexcept {
    const double z = (name >> 31U) != 0U ? size_.z() : -size_.z();
    if ((name & (1U << 30U)) != 0U) return {name, {0.0, 0.0, z}};
    const double t = static_cast<double>(name & 0x0FFFFFFFU) / (angle_steps - 1.0);
    const double cosine = (1.0 - t * t) / (1.0 + t * t);
    const double sine = 2.0 * t / (1.0 + t * t);
    return {name,
            {(name & (1U << 28U)) != 0U ? -size_.x() * cosine : size_.x() * cosine,
             (name & (1U << 29U)) != 0U ? -size_.x() * sine : size_.x() * sine, z}};
  }

  Kind kind_;
  std::uint32_t thick_axes_ = 0;  ///< of a box: bit per axis with an extent
  Vec<double> size_;              ///< [m] half extents; for a cylinder radius, radius, half length
  double reach_ = 0.0;
  VertexScan vertices_;
  SupportTable table_;  ///< of a polytope with many vertices; else empty
};

inline int Convex::vertex_count() const noexcept {
  if (kind_ == Kind::polytope) return vertices_.size();
  if (kind_ == Kind::cylinder) return size_.x() > 0.0 ? 0 : (size_.z() > 0.0 ? 2 : 1);
  return (size_.x() > 0.0 ? 2 : 1) * (size_.y() > 0.0 ? 2 : 1) * (size_.z() > 0.0 ? 2 : 1);
}

}  // namespace repel
