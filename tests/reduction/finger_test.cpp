// SPDX-License-Identifier: BSD-3-Clause
// A thin finger pressed deep into a block: at any depth, further motion increases the measured
// depth, with every measure.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel {
namespace finger_test {

using Named = std::pair<std::string, Shape>;

constexpr double radius = 0.0025;  ///< [m] half the thickness of the finger
constexpr double half_length = 0.05;
const Vec3 half_block{0.15, 0.15, 0.12};

std::vector<Named> fingers(const ReductionOptions& options) {
  const Vec3 half(radius, radius, half_length);
  return {{"box", Shape::box(half, options)},
          {"hull", Shape::hull(families::box(half).vertices, options)},
          {"capsule", Shape::capsule(radius, half_length - radius, options)},
          {"cylinder", Shape::cylinder(radius, half_length, options)}};
}

std::vector<Named> blocks(const ReductionOptions& options) {
  return {{"box", Shape::box(half_block, options)},
          {"hull", Shape::hull(families::box(half_block).vertices, options)}};
}

/// Presses the finger, tilted by `lean` [rad], 5 cm into the block from above. The depth never
/// decreases, never exceeds the travel, and grows by at least `share` of every 5 mm.
void expect_felt(const Shape& finger, const Shape& block, const QueryOptions& options, double lean,
                 double share) {
  constexpr double step = 1e-4;
  constexpr int steps_of_5_mm = 50;
  Pose X_WA = Pose::Identity();
  X_WA.linear() = (Eigen::AngleAxisd(0.7, Vec3::UnitZ()) * Eigen::AngleAxisd(lean, Vec3::UnitX()))
                      .toRotationMatrix();
  const Vec3 down = -X_WA.linear().row(2).transpose();
  const Level& outermost = finger.level(0);
  const double tip = outermost.core.support_value(Vec<double>(down)) + outermost.depth;
  WarmStart warm;
  double before = 0.0;
  double before_5_mm = 0.0;
  for (int i = 1; i <= 10 * steps_of_5_mm; ++i) {
    const double travel = i * step;
    X_WA.translation() = Vec3(0.01, -0.02, half_block.z() + tip - travel);
    const Separation s = separation(finger, X_WA, block, Pose::Identity(), options, warm);
    const double depth = -s.distance;
    EXPECT_EQ(s.end, QueryEnd::converged) << "at " << travel;
    EXPECT_GE(depth, before - 1e-12) << "at " << travel;
    EXPECT_LE(depth, travel + 1e-12);
    EXPECT_GT(s.extraction_W.z(), 0.99) << "at " << travel;
    if (i % steps_of_5_mm == 0) {
      EXPECT_GE(depth - before_5_mm, share * 0.005) << "at " << travel;
      before_5_mm = depth;
    }
    before = depth;
  }
}

void expect_felt_by_all(const ReductionOptions& levels, Measure measure) {
  const QueryOptions options{.measure = measure};
  for (const auto& [finger, A] : fingers(levels)) {
    for (const auto& [block, B] : blocks(levels)) {
      SCOPED_TRACE(std::to_string(levels.levels) + " levels, " + finger + " into " + block);
      expect_felt(A, B, options, 0.0, 1.0 - 1e-9);
      // The largest loss is the dead zone of the first level, which cuts off the leading corner.
      expect_felt(A, B, options, 0.1, 0.95);
      expect_felt(A, B, options, 0.3, 0.85);
    }
  }
}

TEST(Finger, IsFeltAllTheWayByReduction) {
  for (const int levels : {1, 4, 8, 16, 32}) {
    expect_felt_by_all({.levels = levels}, Measure::reduction);
  }
}

TEST(Finger, IsFeltAllTheWayHoweverTheLevelsAreSpaced) {
  for (const double spacing : {0.25, 2.0, 4.0}) {
    expect_felt_by_all({.levels = 8, .spacing = spacing}, Measure::reduction);
  }
}

TEST(Finger, IsFeltAllTheWayByTheDeepestPoint) {
  expect_felt_by_all({}, Measure::deepest_point);
}

TEST(Finger, IsFeltAllTheWayByTheExactDepth) {
  expect_felt_by_all({}, Measure::exact);
}

// The levels of a cone retract its tip by 40 mm per millimetre of depth, as documented in
// docs/reduction.md.
TEST(Finger, ThatIsAConeIsFeltAllTheWayByTheDeepestPointAndLateByLevels) {
  const Shape cone = Shape::cone(radius, half_length, {.levels = 8});
  const Shape block = Shape::box(half_block, {.levels = 8});
  Pose X_WA = Pose::Identity();
  X_WA.linear() = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  for (const double travel : {0.005, 0.025, 0.05}) {
    X_WA.translation().z() = half_block.z() + half_length - travel;
    const Separation s = separation(cone, X_WA, block, Pose::Identity());
    EXPECT_NEAR(s.distance, -travel, 1e-9);
    EXPECT_GT(s.extraction_W.z(), 0.99);
  }
  const QueryOptions by_levels{.measure = Measure::reduction};
  EXPECT_NEAR(separation(cone, X_WA, block, Pose::Identity(), by_levels).distance, -0.0012, 5e-5);
}

}  // namespace finger_test
}  // namespace repel
