/// @file
/// Convex shapes as users build them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/planes.hpp>
#include <repel/reduction/hull_ladder.hpp>
#include <repel/reduction/ladder.hpp>

namespace repel {

/// A convex shape around the origin of its own frame, with its reduced forms. An immutable value:
/// copies share the data. Building allocates and throws SetupError for a size that is not allowed.
class Shape {
 public:
  /// Largest size accepted [m]: beyond it products of lengths lose meaning.
  static constexpr double largest = 1e6;

  /// Faces at +-`half_extents` [m], each 0 to 1e6; a zero makes a rectangle, a segment or a point.
  static Shape box(const Vec3& half_extents, const ReductionOptions& options = {}) {
    checked("half extent x", half_extents.x(), 0.0, largest, "m");
    checked("half extent y", half_extents.y(), 0.0, largest, "m");
    checked("half extent z", half_extents.z(), 0.0, largest, "m");
    return Shape(detail::box_ladder(half_extents, allowed(options)), Planes::box(half_extents));
  }

  /// `radius` [m] 0 to 1e6. Exact: a point with a radius.
  static Shape sphere(double radius, const ReductionOptions& options = {}) {
    (void)allowed(options);
    return Shape(detail::sphere_ladder(checked("radius", radius, 0.0, largest, "m")),
                 Planes::box(Vec3::Zero()));
  }

  /// All points within `radius` [m] of the segment of +-`half_length` [m] on the z axis. Exact.
  static Shape capsule(double radius, double half_length, const ReductionOptions& options = {}) {
    (void)allowed(options);
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::capsule_ladder(radius, half_length), Planes::box({0.0, 0.0, half_length}));
  }

  /// Around the z axis, flat ends at +-`half_length` [m]. The rim is a true circle, not a prism.
  static Shape cylinder(double radius, double half_length, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::cylinder_ladder(radius, half_length, allowed(options)),
                 Planes::cylinder(radius, half_length));
  }

  /// A disc of `radius` [m] at -`half_length` [m] on the z axis and the apex at +`half_length`,
  /// each 0 to 1e6. The rim is a true circle.
  static Shape cone(double radius, double half_length, const ReductionOptions& options = {}) {
    checked("radius", radius, 0.0, largest, "m");
    checked("half length", half_length, 0.0, largest, "m");
    return Shape(detail::cone_ladder(radius, half_length, allowed(options)),
                 Planes::cone(radius, half_length));
  }

  /// The convex hull of 1 to 10 000 points [m]; they may coincide, lie inside, on a line or in a
  /// plane.
  static Shape hull(std::span<const Vec3> points, const ReductionOptions& options = {}) {
    checked("number of points", static_cast<double>(points.size()), 1.0, 10000.0, "");
    for (const Vec3& p : points) {
      for (int axis = 0; axis < 3; ++axis) checked("coordinate", p[axis], -largest, largest, "m");
    }
    const std::vector<Facet> facets = hull_facets(points);
    return Shape(detail::hull_ladder(points, allowed(options), facets),
                 detail::hull_planes(points, facets));
  }

  /// [byte] The most that any shape but a hull holds on the heap, known before it is built.
  static std::size_t most_bytes(const ReductionOptions& options = {}) {
    return sizeof(Data) + counters + detail::most_ladder_bytes(allowed(options)) +
           Planes::bytes_of(6);
  }
  /// [byte] The same of a hull of so many points, 1 to 10 000; what it holds is about half as much
  /// when all are corners.
  static std::size_t most_bytes_of_hull(std::size_t points, const ReductionOptions& options = {}) {
    checked("number of points", static_cast<double>(points), 1.0, 10000.0, "");
    return sizeof(Data) + counters + detail::most_ladder_bytes(points, allowed(options)) +
           Planes::bytes_of(2 * points);
  }

  /// [byte] held on the heap, by all copies together.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return sizeof(Data) + counters + detail::bytes_of(data_->ladder) + data_->planes.bytes();
  }
  [[nodiscard]] int levels() const noexcept { return static_cast<int>(data_->ladder.size()); }
  [[nodiscard]] const Level& level(int i) const noexcept { return first_[i]; }
  /// Around the core of the first level; empty for hulls without thickness.
  [[nodiscard]] const Planes& planes() const noexcept { return data_->planes; }
  /// [m] distance of the farthest point from the origin of the shape.
  [[nodiscard]] double reach() const noexcept {
    return data_->ladder.front().core.reach() + data_->ladder.front().depth;
  }
  /// [m] depth of the last level: no signed distance to this shape and another falls below minus
  /// the sum of theirs.
  [[nodiscard]] double deepest() const noexcept { return data_->ladder.back().depth; }

 private:
  struct Data {
    Ladder ladder;
    Planes planes;
  };
  /// [byte] of a shared pointer beside what it points to, at most.
  static constexpr std::size_t counters = 4 * sizeof(void*);

  Shape(Ladder ladder, Planes planes) {
    ladder.shrink_to_fit();
    data_ = std::make_shared<const Data>(Data{std::move(ladder), std::move(planes)});
    first_ = data_->ladder.data();
  }

  static const ReductionOptions& allowed(const ReductionOptions& options) {
    checked("reduction levels", options.levels, 1.0, 64.0, "");
    checked("spacing of the levels", options.spacing, 0.25, 4.0, "");
    return options;
  }

  std::shared_ptr<const Data> data_;
  const Level* first_ = nullptr;  ///< of the ladder, at hand
};

}  // namespace repel
