// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/ladder.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <support/families.hpp>

namespace repel {
namespace ladder_test {

using families::Rng;

constexpr unsigned seed = 311;

/// [m] extent along +x, +y, +z: half extents of a box; radius, radius, half length of a cylinder.
Vec3 extents(const Convex& core) {
  const auto along = [&](const Vec3& axis) {
    return axis.dot(to_vec3(core.support(Vec<double>(axis)).p));
  };
  return {along(Vec3::UnitX()), along(Vec3::UnitY()), along(Vec3::UnitZ())};
}

/// Invariants of every ladder. The erosion is measured axis by axis, which for boxes and cylinders
/// is equivalent to A_i+1 + Ball(t) inside A_i.
void expect_is_a_ladder(const Ladder& ladder) {
  ASSERT_FALSE(ladder.empty());
  EXPECT_EQ(ladder.back().core.vertex_count(), 1) << "the last level is no point";
  EXPECT_EQ(ladder.front().order, 0.0);
  for (std::size_t i = 1; i < ladder.size(); ++i) {
    SCOPED_TRACE("level " + std::to_string(i));
    const double gained = ladder[i].depth - ladder[i - 1].depth;
    const Vec3 before = extents(ladder[i - 1].core);
    const Vec3 after = extents(ladder[i].core);
    EXPECT_GT(ladder[i].order, ladder[i - 1].order);
    EXPECT_GE(gained, 0.0);
    EXPECT_GE(after.minCoeff(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(before[axis] - after[axis], gained - 4e-16 * before.maxCoeff()) << "axis " << axis;
    }
    EXPECT_LT(after.sum(), before.sum()) << "nothing was taken off";
  }
}

/// [m] depth of the last level.
double deepest(const Ladder& ladder) {
  return ladder.back().depth;
}

TEST(Ladder, BoxesOfEveryProportionStepDownToAPoint) {
  for (const int levels : {1, 8, 64}) {
    for (const Vec3& h :
         {Vec3(1, 1, 1), Vec3(0.1, 0.1, 2), Vec3(2, 0.1, 0.1), Vec3(0.3, 0.7, 1.1),
          Vec3(0.5, 0.02, 0.5), Vec3(1, 1, 1e-6), Vec3(1e-6, 1e-3, 1e3), Vec3(1e6, 1e6, 1e6)}) {
      SCOPED_TRACE(std::to_string(levels) + " levels, extents " + to_text(h.x()) + " " +
                   to_text(h.y()) + " " + to_text(h.z()));
      const Ladder ladder = detail::box_ladder(h, {.levels = levels});
      expect_is_a_ladder(ladder);
      EXPECT_EQ(extents(ladder.front().core), h);
      EXPECT_EQ(deepest(ladder), h.minCoeff()) << "all the thickness there is becomes depth";
    }
  }
}

TEST(Ladder, RandomBoxesStepDownToAPoint) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", box " + std::to_string(i));
    const Vec3 h = families::random_box(rng, 1e-4, 10.0).half_extents;
    const Ladder ladder = detail::box_ladder(h, {.levels = 1 + i % 64});
    expect_is_a_ladder(ladder);
    EXPECT_EQ(deepest(ladder), h.minCoeff());
  }
}

TEST(Ladder, ABoxHasAStepPerLevelAndOnePerThicknessStillToLose) {
  for (const int levels : {1, 8, 64}) {
    SCOPED_TRACE(std::to_string(levels) + " levels");
    const std::size_t steps = static_cast<std::size_t>(levels);
    EXPECT_EQ(detail::box_ladder({1, 1, 1}, {.levels = levels}).size(), 1 + steps)
        << "cube: to a point";
    EXPECT_EQ(detail::box_ladder({1, 5, 1}, {.levels = levels}).size(), 2 + steps)
        << "long: to a line";
    EXPECT_EQ(detail::box_ladder({1, 5, 5}, {.levels = levels}).size(), 2 + steps)
        << "plate: to a square";
    EXPECT_EQ(detail::box_ladder({3, 5, 1}, {.levels = levels}).size(), 3 + steps)
        << "to a rectangle, a line";
    EXPECT_EQ(detail::cylinder_ladder(1, 1, {.levels = levels}).size(), 1 + steps);
    EXPECT_EQ(detail::cylinder_ladder(1, 5, {.levels = levels}).size(), 2 + steps);
    EXPECT_EQ(detail::cylinder_ladder(5, 1, {.levels = levels}).size(), 2 + steps);
  }
}

TEST(Ladder, ABoxLosesItsThicknessInEqualSteps) {
  const Ladder ladder = detail::box_ladder({0.4, 0.8, 1.6}, {.levels = 8});
  for (int i = 0; i <= 8; ++i) EXPECT_NEAR(ladder[i].depth, 0.05 * i, 1e-16);
  EXPECT_EQ(ladder[8].core.vertex_count(), 4) << "a rectangle";
  EXPECT_EQ(ladder[9].core.vertex_count(), 2) << "a line";
  EXPECT_EQ(ladder[10].core.vertex_count(), 1) << "a point";
}

TEST(Ladder, StepsAreSpacedAsAsked) {
  for (const double spacing : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    for (const int levels : {1, 8, 64}) {
      const ReductionOptions options{.levels = levels, .spacing = spacing};
      SCOPED_TRACE(std::to_string(levels) + " levels, spacing " + to_text(spacing));
      const Ladder box = detail::box_ladder({0.4, 0.8, 1.6}, options);
      const Ladder cylinder = detail::cylinder_ladder(0.7, 0.4, options);
      const Ladder cone = detail::cone_ladder(1.2, 0.8, options);
      expect_is_a_ladder(box);
      expect_is_a_ladder(cylinder);
      for (const Ladder* ladder : {&box, &cylinder, &cone}) {
        ASSERT_GT(static_cast<int>(ladder->size()), levels);
        for (int i = 0; i <= levels; ++i) {
          const double share = std::pow(static_cast<double>(i) / levels, spacing);
          EXPECT_NEAR((*ladder)[i].depth, share * deepest(*ladder), 1e-15);
        }
      }
    }
  }
}

/// Two levels of a cube of half extent 1, the second reduced by `step`.
Ladder two_levels(double step, double depth) {
  const Vec3 inner = Vec3::Constant(1.0 - step);
  return {{Convex::box(Vec3::Ones()), 0.0, 0.0}, {Convex::box(inner), depth, depth}};
}

const std::vector<Vec3> sides_of_a_box{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};

TEST(Ladder, NoLevelClaimsMoreDepthThanItShows) {
  EXPECT_EQ(detail::verified(two_levels(0.25, 0.25), sides_of_a_box)[1].depth, 0.25);
  EXPECT_EQ(detail::verified(two_levels(0.25, 0.2), sides_of_a_box)[1].depth, 0.2);
  EXPECT_NEAR(detail::verified(two_levels(0.25, 0.3), sides_of_a_box)[1].depth, 0.25, 1e-14);
  EXPECT_NEAR(detail::verified(two_levels(0.25, 0.25 + 1e-12), sides_of_a_box)[1].depth, 0.25,
              1e-14);
}

TEST(Ladder, NoStepIsLargerThanTheRoomInTheParent) {
  Ladder ladder = two_levels(0.5, 0.25);
  ladder.push_back({Convex::box(Vec3::Constant(0.4)), 0.6, 0.6});
  ladder = detail::verified(ladder, sides_of_a_box);
  EXPECT_EQ(ladder[1].depth, 0.25);
  EXPECT_NEAR(ladder[2].depth, 0.35, 1e-14) << "0.1 deeper than its parent says";
}

TEST(Ladder, ALevelThatReachesOutOfItsParentIsRefused) {
  EXPECT_THROW((void)detail::verified(two_levels(-1e-9, 0.0), sides_of_a_box), SetupError);
}

TEST(Ladder, FlatBoxesHaveNoDepthAndGoOnToAPoint) {
  EXPECT_EQ(detail::box_ladder({0, 0, 0}, {.levels = 8}).size(), 1U);
  EXPECT_EQ(detail::box_ladder({0, 1, 0}, {.levels = 8}).size(), 2U);
  EXPECT_EQ(detail::box_ladder({1, 0, 1}, {.levels = 8}).size(), 2U);
  EXPECT_EQ(detail::box_ladder({1, 0, 2}, {.levels = 8}).size(), 3U);
  for (const Vec3& h : {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 1), Vec3(1, 0, 2)}) {
    expect_is_a_ladder(detail::box_ladder(h, {.levels = 8}));
    EXPECT_EQ(deepest(detail::box_ladder(h, {.levels = 8})), 0.0);
  }
}

TEST(Ladder, StepsStayDistinctWhenExtentsNearlyCoincide) {
  for (const double difference : {1e-6, 1e-8, 1e-10, 1e-12, 1e-15}) {
    SCOPED_TRACE("extents differ by " + to_text(difference));
    expect_is_a_ladder(detail::box_ladder({0.1, 0.5, 0.5 + difference}, {.levels = 8}));
    expect_is_a_ladder(detail::box_ladder({0.5, 0.5 + difference, 0.9}, {.levels = 8}));
    expect_is_a_ladder(
        detail::box_ladder({difference, 2 * difference, 3 * difference}, {.levels = 8}));
    expect_is_a_ladder(detail::cylinder_ladder(0.5, 0.5 + difference, {.levels = 8}));
    expect_is_a_ladder(detail::cylinder_ladder(0.5 + difference, 0.5, {.levels = 8}));
  }
}

TEST(Ladder, CylindersShrinkToTheirAxisOrToADiscAndThenToAPoint) {
  for (const int levels : {1, 8, 64}) {
    for (const auto& [radius, half_length] :
         {std::pair{1.0, 1.0}, {0.05, 2.0}, {2.0, 0.05}, {1e-6, 1e3}, {1e3, 1e-6}}) {
      SCOPED_TRACE(std::to_string(levels) + " levels, radius " + to_text(radius));
      const Ladder ladder = detail::cylinder_ladder(radius, half_length, {.levels = levels});
      expect_is_a_ladder(ladder);
      EXPECT_EQ(extents(ladder.front().core), Vec3(radius, radius, half_length));
      EXPECT_EQ(deepest(ladder), std::min(radius, half_length));
    }
  }
}

TEST(Ladder, DiscsAndLinesHaveNoDepthAndOneStepToAPoint) {
  for (const auto& [radius, half_length] : {std::pair{0.5, 0.0}, {0.0, 0.5}}) {
    SCOPED_TRACE("radius " + to_text(radius));
    const Ladder ladder = detail::cylinder_ladder(radius, half_length, {.levels = 8});
    expect_is_a_ladder(ladder);
    EXPECT_EQ(ladder.size(), 2U);
    EXPECT_EQ(deepest(ladder), 0.0);
  }
  expect_is_a_ladder(detail::cylinder_ladder(0.0, 0.0, {.levels = 8}));
  EXPECT_EQ(detail::cylinder_ladder(0.0, 0.0, {.levels = 8}).size(), 1U);
}

TEST(Ladder, ASphereIsAPointWithADepth) {
  const Ladder ladder = detail::sphere_ladder(0.3);
  expect_is_a_ladder(ladder);
  EXPECT_EQ(ladder.size(), 1U);
  EXPECT_EQ(deepest(ladder), 0.3);
}

TEST(Ladder, ACapsuleIsASegmentWithADepthAndThenAPointWithTheSame) {
  const Ladder ladder = detail::capsule_ladder(0.1, 0.4);
  expect_is_a_ladder(ladder);
  ASSERT_EQ(ladder.size(), 2U);
  EXPECT_EQ(extents(ladder[0].core), Vec3(0, 0, 0.4));
  EXPECT_EQ(ladder[0].depth, 0.1);
  EXPECT_EQ(ladder[1].depth, 0.1);
  EXPECT_EQ(detail::capsule_ladder(0.1, 0.0).size(), 1U) << "a sphere";
}

}  // namespace ladder_test
}  // namespace repel
