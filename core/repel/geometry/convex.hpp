// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A convex set given by its support map: the farthest point of the set along a direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include <repel/base/vec.hpp>
#include <repel/geometry/faces.hpp>
#include <repel/geometry/sphere_grid.hpp>
#include <repel/geometry/support_table.hpp>
#include <repel/geometry/vertex_scan.hpp>

namespace repel {

/// A convex set around its own origin. A box with zero extents is a rectangle, a segment or a
/// point; a cylinder with zero half length is a disc. Points are identified by a 32-bit name, so
/// that a simplex of them can be kept from tick to tick in a few bytes: corner signs for a box, the
/// vertex index for a polytope, end and angle (to 1e-8) for a cylinder, a node of a SphereGrid for
/// an ellipsoid.
class Convex {
 public:
  /// Up to so many vertices, a scan of all of them is as fast as a SupportTable.
  static constexpr std::size_t largest_scan = 32;

  /// What the set is.
  enum class Kind : std::uint8_t { box, cylinder, cone, ellipsoid, polytope };

  /// A point of the set that is farthest in some direction.
  template <class T>
  struct Point {
    std::uint32_t name = 0;  ///< tells the points of a set apart, see Convex
    Vec<T> p;                ///< [m] in the frame of the set
  };

  /// A box with corners at +-`half_extents` [m], each at least 0.
  static Convex box(const Vec3& half_extents) {
    Convex set(Kind::box);
    set.size_ = Vec<double>(half_extents);
    set.reach_ = norm(half_extents);
    set.thick_axes_ = (half_extents.x() > 0.0 ? 1U : 0U) | (half_extents.y() > 0.0 ? 2U : 0U) |
                      (half_extents.z() > 0.0 ? 4U : 0U);
    return set;
  }
  /// A cylinder around the z axis; `radius` and `half_length` [m] at least 0.
  static Convex cylinder(double radius, double half_length) {
    Convex set(Kind::cylinder);
    set.size_ = {radius, radius, half_length};
    set.reach_ = std::hypot(radius, half_length);
    return set;
  }
  /// A cone around the z axis: a disc of `radius` [m], at least 0, at `z_base` [m] and the apex at
  /// `z_apex` [m], not below it.
  static Convex cone(double radius, double z_base, double z_apex) {
    Convex set(Kind::cone);
    set.size_ = {radius, z_base, z_apex};
    set.reach_ = std::max(std::hypot(radius, z_base), std::abs(z_apex));
    return set;
  }
  /// An ellipsoid with these semi-axes [m] along x, y and z, each above 0.
  static Convex ellipsoid(const Vec3& semi_axes) {
    Convex set(Kind::ellipsoid);
    set.size_ = Vec<double>(semi_axes);
    set.reach_ = std::max({semi_axes.x(), semi_axes.y(), semi_axes.z()});
    return set;
  }
  /// The convex hull of at least one vertex [m].
  /// @param faces of these vertices, or none: its flat features are then not known
  static Convex polytope(std::span<const Vec3> vertices, Faces faces = {}) {
    Convex set(Kind::polytope);
    set.faces_ = std::move(faces);
    set.vertices_ = VertexScan(vertices);
    if (vertices.size() > largest_scan) set.table_ = SupportTable(vertices);
    for (const Vec3& v : vertices) set.reach_ = std::max(set.reach_, norm(v));
    return set;
  }

  /// [byte] Heap memory held, and the most that a polytope of so many vertices holds beside its
  /// faces.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return vertices_.bytes() + table_.bytes() + faces_.bytes();
  }
  /// [bytes] Upper bound of the heap that a polytope of so many vertices takes.
  [[nodiscard]] static std::size_t most_bytes(std::size_t vertices) noexcept {
    return VertexScan::bytes_of(vertices) +
           (vertices > largest_scan ? SupportTable::most_bytes(vertices) : 0);
  }
  [[nodiscard]] Kind kind() const noexcept { return kind_; }  ///< what the set is
  /// [m] distance of the farthest point from the origin of the frame.
  [[nodiscard]] double reach() const noexcept { return reach_; }
  /// True when the set has finitely many vertices.
  [[nodiscard]] bool is_polytope() const noexcept {
    return kind_ == Kind::box || kind_ == Kind::polytope || size_.x() == 0.0;
  }
  /// Number of vertices; 0 for a set with a curved boundary.
  [[nodiscard]] int vertex_count() const noexcept;

  /// True for a polytope whose support map scans all vertices, at most `largest_scan`.
  [[nodiscard]] bool is_scanned() const noexcept {
    return kind_ == Kind::polytope && table_.empty();
  }
  /// The faces of a polytope; empty for one that is flat, or was made without them.
  [[nodiscard]] const Faces& faces() const noexcept { return faces_; }
  /// The vertices of a polytope.
  [[nodiscard]] VertexBlock vertices() const noexcept { return vertices_.block(); }
  /// [m] The half extents of a box.
  [[nodiscard]] Vec<double> half_extents() const noexcept { return size_; }
  /// [m] Of a cylinder: radius, radius, half length; of a cone: radius, z of base, z of apex; of an
  /// ellipsoid: the semi-axes.
  [[nodiscard]] Vec<double> round_size() const noexcept { return size_; }
  /// The name of a corner of a box by its signs, bit k set where coordinate k is positive. A corner
  /// of a flat box has several sign patterns; the lowest is its name.
  [[nodiscard]] std::uint32_t corner_name(std::uint32_t signs) const noexcept {
    return signs & thick_axes_;
  }

  /// The farthest point along `d`, which need not be unit. T is double or DoubleDouble.
  template <class T>
  [[nodiscard]] Point<T> support(const Vec<T>& d) const noexcept {
    switch (kind_) {
      case Kind::box:
        return named<T>(box_corner(~minus_signs(d)));
      case Kind::cylinder:
        return rim_support(d, d.z() > T(0.0));
      case Kind::cone:
        return cone_support(d);
      case Kind::ellipsoid:
        return oval_support(d);
      case Kind::polytope:
        break;
    }
    const std::uint32_t i = table_.empty() ? vertices_.scan(d) : best_candidate(d);
    return named<T>({i, vertices_.vertex(i)});
  }

  /// The position of the point with that name [m].
  [[nodiscard]] Vec<double> place(std::uint32_t name) const noexcept {
    switch (kind_) {
      case Kind::box:
        return box_corner(name).p;
      case Kind::cylinder:
      case Kind::cone:
        return rim_point<double>(name).p;
      case Kind::ellipsoid:
        return oval_point<double>(name).p;
      case Kind::polytope:
        break;
    }
    return vertices_.vertex(name);
  }

  /// The support function: the largest product of `d` with a point of the set, [m] for unit `d`.
  [[nodiscard]] double support_value(const Vec<double>& d) const noexcept {
    switch (kind_) {
      case Kind::box:
        return dot(size_, magnitudes(d));
      case Kind::cylinder:
        return size_.x() * across(d) + size_.z() * std::abs(d.z());
      case Kind::cone:
        return std::max(size_.x() * across(d) + size_.y() * d.z(), size_.z() * d.z());
      case Kind::ellipsoid: {
        const Vec<double> u = product(size_, d);
        return std::sqrt(dot(u, u));
      }
      case Kind::polytope:
        break;
    }
    if (table_.empty()) return vertices_.block().largest_product(d);
    double largest = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : table_.candidates(d)) {
      largest = std::max(largest, dot(vertices_.vertex(i), d));
    }
    return largest;
  }

  /// The point with that name; any name gives some point of the set. A name refers to the
  /// corresponding point of a set and its reduced forms: the same corner, the same vertex, the same
  /// angle.
  template <class T = double>
  [[nodiscard]] Point<T> point(std::uint32_t name) const noexcept {
    switch (kind_) {
      case Kind::box:
        return named<T>(box_corner(name));
      case Kind::cylinder:
      case Kind::cone:
        return rim_point<T>(name);
      case Kind::ellipsoid:
        return oval_point<T>(name);
      case Kind::polytope:
        break;
    }
    const std::uint32_t i = name < static_cast<std::uint32_t>(vertices_.size()) ? name : 0U;
    return named<T>({i, vertices_.vertex(i)});
  }

 private:
  explicit Convex(Kind kind) noexcept : kind_(kind) {}

  template <class T>
  [[nodiscard]] static Point<T> named(const Point<double>& p) noexcept {
    if constexpr (std::is_same_v<T, double>) {
      return p;
    } else {
      return {p.name, Vec<T>(p.p)};
    }
  }

  static double root(double x) noexcept { return std::sqrt(x); }
  static DoubleDouble root(DoubleDouble x) noexcept { return sqrt(x); }
  /// Length of the component of `d` normal to the z axis.
  template <class T>
  [[nodiscard]] static T across(const Vec<T>& d) noexcept {
    return root(d.x() * d.x() + d.y() * d.y());
  }

  [[nodiscard]] Point<double> box_corner(std::uint32_t name) const noexcept {
    name = corner_name(name);
    static constexpr double signs[8][4] = {{-1, -1, -1, 0}, {1, -1, -1, 0}, {-1, 1, -1, 0},
                                           {1, 1, -1, 0},   {-1, -1, 1, 0}, {1, -1, 1, 0},
                                           {-1, 1, 1, 0},   {1, 1, 1, 0}};
    return {name, product(size_, from_four<double>(signs[name]))};
  }

  // The candidates contain the vertex that a scan of all vertices would find.
  template <class T>
  [[nodiscard]] std::uint32_t best_candidate(const Vec<T>& d) const noexcept {
    const auto candidates = table_.candidates(Vec<double>(d));
    std::uint32_t winner = candidates.front();
    T best = dot(Vec<T>(vertices_.vertex(winner)), d);
    for (std::size_t k = 1; k < candidates.size(); ++k) {
      const T along = dot(Vec<T>(vertices_.vertex(candidates[k])), d);
      if (along > best) {
        best = along;
        winner = candidates[k];
      }
    }
    return winner;
  }

  /// [m] z of the disc (or apex) at the far end or the near end of the z axis.
  [[nodiscard]] double end(bool far) const noexcept {
    if (kind_ == Kind::cone) return far ? size_.z() : size_.y();
    return far ? size_.z() : -size_.z();
  }

  /// The farthest point of one of the two discs. When `d` is along the axis all points are equally
  /// far: the centre is returned.
  template <class T>
  [[nodiscard]] Point<T> rim_support(const Vec<T>& d, bool far) const noexcept {
    const T length = across(d);
    const T z(end(far));
    const T zero(0.0);
    if (!(length > T(1e-300)) || size_.x() == 0.0) return {name_of_centre(far), {zero, zero, z}};
    const T cosine = d.x() / length;
    const T sine = d.y() / length;
    const T radius(size_.x());
    return {name_of_rim(static_cast<double>(cosine), static_cast<double>(sine), far),
            {radius * cosine, radius * sine, z}};
  }

  template <class T>
  [[nodiscard]] Point<T> cone_support(const Vec<T>& d) const noexcept {
    const T base = T(size_.x()) * across(d) + T(size_.y()) * d.z();
    if (base > T(size_.z()) * d.z()) return rim_support(d, false);
    return {name_of_centre(true), {T(0.0), T(0.0), T(size_.z())}};
  }

  /// The image of the unit vector u under the map that takes the unit ball to the ellipsoid. Along
  /// d, it is farthest for u along the image of d.
  template <class T>
  [[nodiscard]] Point<T> oval_support(const Vec<T>& d) const noexcept {
    const Vec<T> size(size_);
    const Vec<T> u(size.x() * d.x(), size.y() * d.y(), size.z() * d.z());
    const T length = root(dot(u, u));
    if (!(length > T(1e-300))) return oval_point<T>(0);
    const Vec<T> p(size.x() * u.x(), size.y() * u.y(), size.z() * u.z());
    return {SphereGrid::nearest(Vec<double>(u)), (T(1.0) / length) * p};
  }
  template <class T>
  [[nodiscard]] Point<T> oval_point(std::uint32_t name) const noexcept {
    const Vec<double> u = SphereGrid::node(name);
    const Vec<T> p = Vec<T>(product(size_, u));
    return {name, (T(1.0) / root(dot(Vec<T>(u), Vec<T>(u)))) * p};
  }

  // Name of a rim point: bit 31 the end, bit 30 set for the centre of the disc, bits 28 and 29 the
  // signs of cosine and sine, the lower bits the tangent of half the angle within its quadrant.
  static constexpr double angle_steps = 268435455.0;  // 2^28 - 1

  [[nodiscard]] static std::uint32_t name_of_centre(bool far) noexcept {
    return (far ? 1U << 31U : 0U) | 1U << 30U;
  }
  [[nodiscard]] static std::uint32_t name_of_rim(double cosine, double sine, bool far) noexcept {
    const double half_tangent = std::abs(sine) / (1.0 + std::abs(cosine));  // 0 to 1
    const double step = half_tangent <= 1.0 ? half_tangent * (angle_steps - 1.0) : 0.0;
    return (far ? 1U << 31U : 0U) | (cosine < 0.0 ? 1U << 28U : 0U) |
           (sine < 0.0 ? 1U << 29U : 0U) | static_cast<std::uint32_t>(step);
  }
  template <class T>
  [[nodiscard]] Point<T> rim_point(std::uint32_t name) const noexcept {
    const bool far = (name >> 31U) != 0U;
    const T z(end(far));
    const bool apex = kind_ == Kind::cone && far;
    if (apex || (name & (1U << 30U)) != 0U) return {name, {T(0.0), T(0.0), z}};
    const T one(1.0);
    const T t = T(static_cast<double>(name & 0x0FFFFFFFU)) / T(angle_steps - 1.0);
    const T scale = T(size_.x()) / (one + t * t);
    const T x = scale * (one - t * t);
    const T y = scale * (T(2.0) * t);
    return {name, {(name & (1U << 28U)) != 0U ? -x : x, (name & (1U << 29U)) != 0U ? -y : y, z}};
  }

  // The members used by a box come first, for cache locality.
  Kind kind_;
  std::uint32_t thick_axes_ = 0;  ///< of a box: one bit per axis with nonzero extent
  double reach_ = 0.0;            ///< [m]
  Vec<double> size_{};  ///< [m] box: half extents; cylinder: radius, radius, half length; cone:
                        ///< radius, z of base, z of apex; ellipsoid: semi-axes
  VertexScan vertices_;
  Faces faces_;
  SupportTable table_;  ///< of a polytope with many vertices; otherwise empty
};

inline int Convex::vertex_count() const noexcept {
  if (kind_ == Kind::polytope) return vertices_.size();
  if (kind_ == Kind::ellipsoid) return 0;
  if (kind_ == Kind::cylinder || kind_ == Kind::cone) {
    return size_.x() > 0.0 ? 0 : (end(true) > end(false) ? 2 : 1);
  }
  return (size_.x() > 0.0 ? 2 : 1) * (size_.y() > 0.0 ? 2 : 1) * (size_.z() > 0.0 ? 2 : 1);
}

}  // namespace repel
