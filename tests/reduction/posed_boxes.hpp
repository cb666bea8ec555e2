// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two boxes at random poses, their shapes, and their exact distance and depth.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <repel/reduction/separation.hpp>
#include <support/exact_depth.hpp>
#include <support/families.hpp>
#include <support/oracle.hpp>

namespace repel::test {

using families::Rng;

struct PosedBoxes {
  Vec3 half_a, half_b;  ///< [m]
  Shape A, B;
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();

  PosedBoxes(const Vec3& a, const Vec3& b, const ReductionOptions& options = {})
      : half_a(a), half_b(b), A(Shape::box(a, options)), B(Shape::box(b, options)) {}

  [[nodiscard]] Separation separate(const QueryOptions& options = {}) const {
    return separation(A, X_WA, B, X_WB, options);
  }
  [[nodiscard]] Separation separate(WarmStart& warm, const QueryOptions& options = {}) const {
    return separation(A, X_WA, B, X_WB, options, warm);
  }
  /// [m] exact; not positive when the boxes are apart.
  [[nodiscard]] double depth() const {
    return oracle::penetration_depth(half_a, X_WA, half_b, X_WB);
  }
  /// [m] The exact signed distance; NaN if 113-bit arithmetic could not prove it.
  [[nodiscard]] double truth() const {
    if (depth() > 0.0) return -depth();
    const auto found = oracle::distance(families::box(half_a).vertices, X_WA,
                                        families::box(half_b).vertices, X_WB);
    return found ? static_cast<double>(found->distance) : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double size() const { return A.reach() + B.reach(); }
};

/// Two boxes of extents 0.1 to 1 m, B within `reach` [m] of A.
inline PosedBoxes random_boxes(Rng& rng, double reach, const ReductionOptions& options = {}) {
  const Vec3 half_a = families::random_box(rng, 0.1, 1.0).half_extents;
  const Vec3 half_b = families::random_box(rng, 0.1, 1.0).half_extents;
  PosedBoxes boxes(half_a, half_b, options);
  boxes.X_WA.linear() = families::rotation(rng);
  boxes.X_WB.linear() = families::rotation(rng);
  boxes.X_WA.translation() = families::uniform(rng, 0.0, 1.0) * families::direction(rng);
  boxes.X_WB.translation() =
      boxes.X_WA.translation() + families::uniform(rng, 0.0, reach) * families::direction(rng);
  return boxes;
}

/// The same, overlapping.
inline PosedBoxes overlapping_boxes(Rng& rng, const ReductionOptions& options = {}) {
  while (true) {
    const PosedBoxes boxes = random_boxes(rng, 1.5, options);
    if (boxes.depth() > 1e-6) return boxes;
  }
}

/// A straight path through B, with `steps` steps from one side of it to the other.
struct Sweep {
  Vec3 from, along;  ///< [m], unit
  double length;     ///< [m]

  Sweep(const PosedBoxes& boxes, Rng& rng)
      : along(families::direction(rng)), length(2.5 * boxes.size()) {
    const Vec3 aside = 0.3 * boxes.B.reach() * families::direction(rng);
    from = boxes.X_WB.translation() + aside - 0.5 * length * along;
  }
  [[nodiscard]] Vec3 at(double share) const { return from + share * length * along; }
};

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace repel::test
