// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The face planes of a polytope, and the depth of a point below them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <repel/base/lanes.hpp>
#include <repel/geometry/oval_tangents.hpp>
#include <repel/geometry/tangents.hpp>

namespace repel {

/// The half space n.x <= offset that contains a hull and touches it in a facet.
struct Facet {
  std::array<int, 3> vertices{};  ///< indices, counter-clockwise seen from outside
  Vec3 n{0, 0, 0};                ///< unit, outward
  double offset = 0.0;            ///< [m]
};

/// Half spaces n.x <= offset, n unit, whose intersection is a polytope. Stored as padded arrays of
/// all n.x, n.y, n.z and offsets, one after the other; the tangent planes of a curved side follow
/// by index and are not stored. Empty for a set that is not described by planes.
class Planes {
 public:
  Planes() = default;
  /// @param margin see margin()
  /// @param sharpness see sharpness()
  explicit Planes(const std::vector<Facet>& facets, double margin = 0.0, double sharpness = 2.0,
                  Tangents side = {})
      : side_(side),
        margin_(margin),
        sharpness_(sharpness),
        size_(facets.size()),
        stride_(stride_of(facets.size())),
        numbers_(4 * stride_) {
    for (std::size_t i = 0; i < stride_; ++i) {
      const Facet& f = facets[i < facets.size() ? i : 0];
      for (std::size_t axis = 0; axis < 3; ++axis) numbers_[axis * stride_ + i] = f.n[axis];
      numbers_[3 * stride_ + i] = f.offset;
    }
  }
  /// The planes of a box with corners +-`half_extents` [m]. Where one is 0 two planes coincide, and
  /// no point has a depth above 0.
  static Planes box(const Vec3& half_extents) {
    std::vector<Facet> facets;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {1.0, -1.0}) {
        facets.push_back({{}, side * unit(axis), half_extents[axis]});
      }
    }
    Planes planes(facets);
    planes.is_box_ = true;
    return planes;
  }
  /// A cylinder around the z axis, flat ends at +-`half_length` [m].
  static Planes cylinder(double radius, double half_length) {
    if (!(radius > 0.0)) return box({0.0, 0.0, half_length});
    return Planes({{{}, unit(2), half_length}, {{}, -unit(2), half_length}},
                  Tangents::sagitta(radius), 2.0, {1.0, 0.0, radius});
  }
  /// A cone around the z axis, the base of `radius` [m] at -`half_length` [m], the apex at
  /// +`half_length`.
  static Planes cone(double radius, double half_length) {
    if (!(radius > 0.0 && half_length > 0.0)) return cylinder(radius, half_length);
    const double length = 2.0 * half_length;
    const double side = std::hypot(radius, length);
    // At a sharp apex or rim, rounding of the planes enlarges the intersection most.
    const double sharp = std::min(radius, length) / side;
    const double margin = Tangents::sagitta(radius) + 4e-15 * side / sharp;
    return Planes({{{}, -unit(2), half_length}}, margin, 2.0 / sharp,
                  {length / side, radius / side, half_length * radius / side});
  }
  /// An ellipsoid with these semi-axes [m], each above 0.
  static Planes ellipsoid(const Vec3& semi_axes) {
    Planes planes = box(semi_axes);
    planes.is_box_ = false;
    planes.oval_ = OvalTangents(semi_axes);
    // The planes protrude, and the one that is found may not be the nearest of all.
    const double oblong = semi_axes.maxCoeff() / semi_axes.minCoeff();
    planes.margin_ = 2.0 * planes.oval_.sagitta() + 4e-15 * oblong * semi_axes.maxCoeff();
    return planes;
  }

  /// There is none.
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  /// [m] Largest distance from the set of a point below all planes: by rounding, and by the sagitta
  /// of a curved side.
  [[nodiscard]] double margin() const noexcept { return margin_; }
  /// [-] A point at most d above each plane is at most margin() + d sharpness() outside the set: at
  /// the tip of a sliver, far.
  [[nodiscard]] double sharpness() const noexcept { return sharpness_; }
  /// [m] By how much a plane may be violated without being worth another step of a search: less
  /// than the margin, 0 for all but ellipsoids.
  [[nodiscard]] double slack() const noexcept { return oval_.sagitta(); }
  /// Number of planes.
  [[nodiscard]] std::uint32_t size() const noexcept {
    return listed() + side_.size() + oval_.size();
  }
  /// [byte] Heap memory held, and the heap memory of so many planes.
  [[nodiscard]] std::size_t bytes() const noexcept { return numbers_.capacity() * sizeof(double); }
  /// [bytes] Of heap that so many planes take.
  [[nodiscard]] static std::size_t bytes_of(std::size_t planes) noexcept {
    return 4 * stride_of(planes) * sizeof(double);
  }

  /// Unit, outward; `i` less than size().
  [[nodiscard]] Vec<double> normal(std::uint32_t i) const noexcept {
    if (i >= size_) return is_oval() ? oval_.normal(i - listed()) : side_.normal(i - listed());
    return {numbers_[i], numbers_[stride_ + i], numbers_[2 * stride_ + i]};
  }
  /// [m]
  [[nodiscard]] double offset(std::uint32_t i) const noexcept {
    if (i < size_) return numbers_[3 * stride_ + i];
    return is_oval() ? oval_.offset(i - listed()) : side_.offset();
  }

  /// True for the six planes of a box: plane 2 k and 2 k + 1 are normal to axis k, outward along it
  /// and against it.
  [[nodiscard]] bool is_box() const noexcept { return is_box_; }
  /// True when some planes are tangent to a curved side.
  [[nodiscard]] bool is_round() const noexcept { return side_.size() > 0 || is_oval(); }
  /// True for the planes of an ellipsoid.
  [[nodiscard]] bool is_oval() const noexcept { return oval_.size() > 0; }
  /// The two tangent planes that face along `x`, seen from the axis. Of an ellipsoid: that which
  /// touches on the ray through `x`, and the nearest to `x`. Must be round.
  [[nodiscard]] std::array<std::uint32_t, 2> facing(const Vec<double>& x) const noexcept {
    if (is_oval()) return {listed() + oval_.behind(x), listed() + oval_.nearest(x)};
    const std::array<std::uint32_t, 2> names = side_.around(x);
    return {listed() + names[0], listed() + names[1]};
  }

  /// The plane nearest to a point.
  template <class T>
  struct Nearest {
    std::uint32_t plane;  ///< its index
    T depth;              ///< [m] of the point below the plane; negative above
  };
  /// The plane below which `x` has the least depth, the first of several; for a point of the
  /// polytope, its depth. Must not be empty. Cost: one pass over the planes.
  [[nodiscard]] Nearest<double> nearest(const Vec<double>& x) const noexcept;
  /// The same in extended precision. Cost: two passes.
  [[nodiscard]] Nearest<DoubleDouble> nearest(const Vec<DoubleDouble>& x) const noexcept;

 private:
  /// For a box, from its three half extents.
  [[nodiscard]] Nearest<double> nearest_of_box(const Vec<double>& x) const noexcept;
  [[nodiscard]] Nearest<double> nearest_of_listed(const Vec<double>& x) const noexcept;

  static constexpr std::size_t lanes = 8;  ///< the arrays are padded to a multiple of this

  [[nodiscard]] static std::size_t stride_of(std::size_t planes) noexcept {
    return (planes + lanes - 1) / lanes * lanes;
  }

  [[nodiscard]] detail::Lanes numbers(std::size_t row, std::size_t i) const noexcept {
    detail::Lanes some;
    std::memcpy(&some, numbers_.data() + row * stride_ + i, sizeof some);
    return some;
  }

  [[nodiscard]] std::uint32_t listed() const noexcept { return static_cast<std::uint32_t>(size_); }

  Tangents side_;
  OvalTangents oval_;
  bool is_box_ = false;
  double margin_ = 0.0;
  double sharpness_ = 2.0;
  std::size_t size_ = 0;
  std::size_t stride_ = 0;
  std::vector<double> numbers_;
};

inline Planes::Nearest<double> Planes::nearest_of_box(const Vec<double>& x) const noexcept {
  const Vec<double> beyond = magnitudes(x);
  const std::array<double, 3> depth{offset(0) - beyond.x(), offset(2) - beyond.y(),
                                    offset(4) - beyond.z()};
  std::uint32_t axis = depth[1] < depth[0] ? 1 : 0;
  double least = std::min(depth[0], depth[1]);
  axis = depth[2] < least ? 2 : axis;
  least = std::min(least, depth[2]);
  return {2 * axis + (minus_signs(x) >> axis & 1U), least};
}

inline Planes::Nearest<double> Planes::nearest_of_listed(const Vec<double>& x) const noexcept {
  using detail::Lanes;
  constexpr double none = std::numeric_limits<double>::infinity();
  Lanes best = Lanes{} + none;
  Lanes winner{};
  Lanes here = detail::lanes_of([](int k) { return static_cast<double>(k); });
  for (std::size_t i = 0; i < stride_; i += detail::lane_count) {
    const Lanes height = numbers(0, i) * x.x() + numbers(1, i) * x.y() + numbers(2, i) * x.z();
    const Lanes depth = numbers(3, i) - height;
    const auto nearer = depth < best;
    best = either(nearer, depth, best);
    winner = either(nearer, here, winner);
    here = here + static_cast<double>(detail::lane_count);
  }
  const double least = detail::least_of(best);
  const Lanes first = either(best == detail::all_of(least), winner, Lanes{} + none);
  return {static_cast<std::uint32_t>(detail::least_of(first)), least};
}

inline Planes::Nearest<double> Planes::nearest(const Vec<double>& x) const noexcept {
  if (is_box_) return nearest_of_box(x);
  const Nearest<double> of_listed = nearest_of_listed(x);
  if (!is_round()) return of_listed;
  if (is_oval()) {
    const std::uint32_t name = listed() + oval_.nearest(x);
    const double depth = offset(name) - dot(normal(name), x);
    return depth < of_listed.depth ? Nearest<double>{name, depth} : of_listed;
  }
  const std::uint32_t on_side = side_.nearest(x);
  const double depth = side_.offset() - dot(side_.normal(on_side), x);
  return depth < of_listed.depth ? Nearest<double>{listed() + on_side, depth} : of_listed;
}

inline Planes::Nearest<DoubleDouble> Planes::nearest(const Vec<DoubleDouble>& x) const noexcept {
  const Vec<double> rounded(x);
  const double least = nearest(rounded).depth;
  const double in_doubt = least + 0x1p-48 * (std::abs(least) + sum(magnitudes(rounded)));
  Nearest<DoubleDouble> found{0, std::numeric_limits<double>::infinity()};
  const auto offer = [&](std::uint32_t i) {
    const DoubleDouble depth = DoubleDouble(offset(i)) - dot(Vec<DoubleDouble>(normal(i)), x);
    if (depth < found.depth) found = {i, depth};
  };
  for (std::uint32_t i = 0; i < listed(); ++i) {
    if (offset(i) - dot(normal(i), rounded) <= in_doubt) offer(i);
  }
  if (is_round()) {
    for (const std::uint32_t i : facing(rounded)) offer(i);
  }
  return found;
}

}  // namespace repel
