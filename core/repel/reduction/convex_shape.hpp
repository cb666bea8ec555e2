// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A convex shape, and how all but hulls are built. Whoever builds hulls includes
/// reduction/shape.hpp.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/planes.hpp>
#include <repel/reduction/ladder.hpp>

namespace repel {

namespace detail {

/// How hulls are built: defined in reduction/shape.hpp.
template <class Options>
struct HullBuilding {
  static_assert(!std::same_as<Options, ReductionOptions>,
                "who builds hulls, or reduces them again, includes <repel/reduction/shape.hpp>");
};

}  // namespace detail

/// A convex shape around the origin of its own frame, with its reduced forms. An immutable value:
/// copies share the data. Construction allocates and throws SetupError for a size out of range.
class Shape {
 public:
  /// Largest size accepted [m]: beyond it products of lengths lose their meaning.
  static constexpr double largest = 1e6;

  /// A box with faces at +-`half_extents` [m], each 0 to 1e6; with zeros a rectangle, a segment or
  /// a point.
  static Shape box(const Vec3& half_extents, const ReductionOptions& options = {}) {
    checked("half extent x", half_extents.x(), 0.0, largest, "m");
    checked("half extent y", half_extents.y(), 0.0, largest, "m");
    checked("half extent z", half_extents.z(), 0.0, largest, "m");
    return Shape(detail::box_ladder(half_extents, allowed(options)), Planes::box(half_extents),
                 options);
  }

  /// A sphere of `radius` [m], 0 to 1e6. Exact: a point with a depth.
  static Shape sphere(double radius, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    return Shape(detail::sphere_ladder(radius), Planes::box({0, 0, 0}), allowed(options));
  }

  /// All points within `radius` [m] of the segment between +-`half_length` [m] on the z axis.
  /// Exact.
  static Shape capsule(double radius, double half_length, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::capsule_ladder(radius, half_length), Planes::box({0.0, 0.0, half_length}),
                 allowed(options));
  }

  /// A cylinder around the z axis, flat ends at +-`half_length` [m]. The rim is an exact circle,
  /// not a polygon.
  static Shape cylinder(double radius, double half_length, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::cylinder_ladder(radius, half_length, allowed(options)),
                 Planes::cylinder(radius, half_length), options);
  }

  /// A cone: a disc of `radius` [m] at -`half_length` [m] on the z axis and the apex at
  /// +`half_length`, each 0 to 1e6. The rim is an exact circle.
  static Shape cone(double radius, double half_length, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::cone_ladder(radius, half_length, allowed(options)),
                 Planes::cone(radius, half_length), options);
  }

  /// The largest semi-axis of an ellipsoid over its least one.
  static constexpr double most_oblong = 1e4;

  /// An ellipsoid with these semi-axes [m] along x, y and z: each 1e-6 to 1e6, the largest at most
  /// 1e4 times the least. The surface is exact, not a mesh; with equal semi-axes a sphere.
  static Shape ellipsoid(const Vec3& semi_axes, const ReductionOptions& options = {}) {
    checked("semi-axis x", semi_axes.x(), 1e-6, largest, "m");
    checked("semi-axis y", semi_axes.y(), 1e-6, largest, "m");
    checked("semi-axis z", semi_axes.z(), 1e-6, largest, "m");
    const auto [least, most] = std::minmax({semi_axes.x(), semi_axes.y(), semi_axes.z()});
    checked("largest over least semi-axis", most / least, 1.0, most_oblong, "");
    if (least == most) return sphere(most, options);
    return Shape(detail::ellipsoid_ladder(semi_axes, allowed(options)),
                 Planes::ellipsoid(semi_axes), options);
  }

  /// The convex hull of 1 to 10 000 points [m]; they may coincide, be interior, collinear or
  /// coplanar. Whoever builds one includes reduction/shape.hpp. A template, always of
  /// ReductionOptions: others need not compile the building of hulls.
  template <std::same_as<ReductionOptions> Options = ReductionOptions>
  static Shape hull(std::span<const Vec3> points, const Options& options = {}) {
    return detail::HullBuilding<Options>::shape(points, options);
  }

  /// The same shape reduced in another way. The first level and the planes are the same, so only
  /// the depth of an overlap by `Measure::reduction` differs. Costs as much as building the shape.
  /// Needs reduction/shape.hpp, as `hull` does.
  template <std::same_as<ReductionOptions> Options = ReductionOptions>
  [[nodiscard]] Shape reduced(const Options& options) const {
    return Shape(ladder(allowed(options)), planes(), options, inscribed_radius());
  }

  /// [byte] Upper bound of the heap memory of any shape except a hull, known before it is built.
  static std::size_t most_bytes(const ReductionOptions& options = {}) {
    return sizeof(Data) + counters + detail::most_ladder_bytes(allowed(options)) +
           Planes::bytes_of(6);
  }
  /// [byte] The same for a hull of so many points, 1 to 10 000; the actual size is about half of it
  /// when all are vertices.
  static std::size_t most_bytes_of_hull(std::size_t points, const ReductionOptions& options = {}) {
    checked("number of points", static_cast<double>(points), 1.0, 10000.0, "");
    return sizeof(Data) + counters + detail::most_ladder_bytes(points, allowed(options)) +
           Planes::bytes_of(2 * points);
  }

  /// [byte] Heap memory held, shared by all copies.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return sizeof(Data) + counters + detail::bytes_of(data_->ladder) + data_->planes.bytes();
  }
  /// Number of levels, at least one.
  [[nodiscard]] int levels() const noexcept { return static_cast<int>(data_->ladder.size()); }
  /// A level, 0: the shape itself; `i` less than levels().
  [[nodiscard]] const Level& level(int i) const noexcept { return first_[i]; }
  /// The planes around the core of the first level; empty for hulls without thickness.
  [[nodiscard]] const Planes& planes() const noexcept { return data_->planes; }
  /// [m] distance of the farthest point from the origin of the shape.
  [[nodiscard]] double reach() const noexcept {
    return data_->ladder.front().core.reach() + data_->ladder.front().depth;
  }
  /// [m] Depth of the last level. By `Measure::reduction`, the signed distance of two shapes is
  /// never below minus the sum of theirs.
  [[nodiscard]] double deepest() const noexcept { return data_->ladder.back().depth; }
  /// [m] How deep a point of the shape can be below its surface, however the shape is reduced; of a
  /// hull, the radius of the largest ball found in it. At least `deepest()`.
  [[nodiscard]] double inscribed_radius() const noexcept { return data_->inscribed_radius; }
  /// How the levels were made.
  [[nodiscard]] const ReductionOptions& reduction() const noexcept { return data_->reduction; }

 private:
  template <class>
  friend struct detail::HullBuilding;

  struct Data {
    Ladder ladder;
    Planes planes;
    ReductionOptions reduction;
    double inscribed_radius;  ///< [m]
  };
  /// [byte] Upper bound of the control block of a shared pointer.
  static constexpr std::size_t counters = 4 * sizeof(void*);

  Shape(Ladder ladder, Planes planes, const ReductionOptions& reduction, double radius = 0.0) {
    radius = std::max(radius, ladder.back().depth);
    // make_shared would add a tenth of the time that all of Eigen takes to compile.
    data_.reset(new Data{without_spare(ladder), std::move(planes), reduction, radius});
    first_ = data_->ladder.data();
  }

  /// Moves the levels to memory of their exact size.
  static Ladder without_spare(Ladder& ladder) {
    Ladder moved;
    moved.reserve(ladder.size());
    for (Level& level : ladder) moved.push_back(std::move(level));
    return moved;
  }

  template <class Options>
  [[nodiscard]] Ladder ladder(const Options& options) const {
    const Convex& core = level(0).core;
    if (level(0).depth > 0.0) return data_->ladder;  // exact, with any number of levels
    switch (core.kind()) {
      case Convex::Kind::box:
        return detail::box_ladder(to_vec3(core.half_extents()), options);
      case Convex::Kind::cylinder:
        return detail::cylinder_ladder(core.round_size().x(), core.round_size().z(), options);
      case Convex::Kind::cone:
        return detail::cone_ladder(core.round_size().x(), core.round_size().z(), options);
      case Convex::Kind::ellipsoid:
        return detail::ellipsoid_ladder(to_vec3(core.round_size()), options);
      case Convex::Kind::polytope:
        break;
    }
    return detail::HullBuilding<Options>::ladder(core, options);
  }

  static const ReductionOptions& allowed(const ReductionOptions& options) {
    checked("reduction levels", options.levels, 1.0, ReductionOptions::most_levels, "");
    checked("spacing of the levels", options.spacing, 0.25, 4.0, "");
    return options;
  }

  std::shared_ptr<const Data> data_;
  const Level* first_ = nullptr;  ///< the first level, cached
};

/// A shape at its pose, for the length of a call: it owns neither.
struct PosedShape {
  const Shape& shape;  ///< must outlive the call
  const Pose& X_W;     ///< [m] likewise
};

}  // namespace repel
