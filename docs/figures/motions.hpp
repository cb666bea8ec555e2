// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The straight motions of Figures 3, 5 and 6 of Anderson 1993, as pairs of long prisms: the
/// figures are their cross sections.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

namespace repel::figures {

/// A moves along x past a fixed B.
struct Motion {
  Shape A, B;
  Pose X_WA = Pose::Identity();  ///< at position 0
  double first = 0.0;            ///< [m] position along x where the motion begins
  double last = 0.0;             ///< [m] and where it ends

  [[nodiscard]] Pose at(double position) const {
    Pose X = X_WA;
    X.translation().x() += position;
    return X;
  }
};

struct Sample {
  double position = 0.0;  ///< [m]
  Separation separation;

  [[nodiscard]] double distance() const { return separation.distance; }
  /// Where A is pushed, [deg] in the xy plane, -90 to 270: 180 is back, 90 is up.
  [[nodiscard]] double direction() const {
    const Vec3& n = separation.extraction_W;
    const double angle = std::atan2(n.y(), n.x()) * 180.0 / std::numbers::pi;
    return angle < -90.0 ? angle + 360.0 : angle;
  }
};

/// The answers along a motion in equal steps, each query warm from the one before.
inline std::vector<Sample> answers_along(const Motion& motion, Measure measure, int steps) {
  std::vector<Sample> samples;
  WarmStart warm;
  for (int i = 0; i <= steps; ++i) {
    const double position = motion.first + (motion.last - motion.first) * i / steps;
    samples.push_back({position, separation(motion.A, motion.at(position), motion.B,
                                            Pose::Identity(), {.measure = measure}, warm)});
  }
  return samples;
}

/// Figure 3: a small rectangle, turned by `tilt` [rad], moves into a large one from the left, near
/// its upper side.
inline Motion into_a_box(int levels, double tilt = 0.0) {
  Motion motion{.A = Shape::box({0.02, 0.01, 0.2}, {.levels = levels}),
                .B = Shape::box({0.1, 0.05, 0.2}, {.levels = levels})};
  motion.X_WA = Eigen::Translation3d(0.0, 0.025, 0.0) * Eigen::AngleAxisd(tilt, Vec3::UnitZ());
  motion.first = -0.14;
  return motion;
}

/// Figures 5 and 6: a triangle moves through a rectangle from the left to the right.
inline Motion through_a_rectangle(int levels) {
  std::vector<Vec3> corners;
  for (const double z : {-0.2, 0.2}) {
    corners.insert(corners.end(), {{-0.05, -0.03, z}, {0.05, -0.03, z}, {0.0, 0.05, z}});
  }
  return {.A = Shape::hull(corners, {.levels = levels}),
          .B = Shape::box({0.03, 0.06, 0.2}, {.levels = levels}),
          .X_WA = Pose(Eigen::Translation3d(0.0, 0.04, 0.0)),
          .first = -0.11,
          .last = 0.11};
}

/// Index of the first sample at the deepest position; a nanometre less is not deeper.
inline std::size_t deepest_of(const std::vector<Sample>& samples) {
  std::size_t deepest = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].distance() < samples[deepest].distance() - 1e-9) deepest = i;
  }
  return deepest;
}

/// Length [m] of the longest stretch in overlap, before the deepest position, over which the
/// distance stands still: the widest equidistance region.
inline double widest_flat(const std::vector<Sample>& samples) {
  double longest = 0.0;
  double length = 0.0;
  for (std::size_t i = 1; i <= deepest_of(samples); ++i) {
    const double step = samples[i].position - samples[i - 1].position;
    const double fall = samples[i - 1].distance() - samples[i].distance();
    length = samples[i].distance() < 0.0 && fall < 1e-6 * step ? length + step : 0.0;
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace repel::figures
