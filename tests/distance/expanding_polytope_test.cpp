#include <repel/distance/expanding_polytope.hpp>

#include <gtest/gtest.h>

#include <string>

#include <repel/distance/box_depth.hpp>
#include <repel/distance/gjk.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace expanding_polytope_test {

using families::Rng;

constexpr unsigned seed = 515;

TEST(ExpandingPolytope, FindsTheDepthOfBoxes) {
  Rng rng(seed);
  int overlapping = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const Convex A = Convex::box(families::random_box(rng, 0.1, 0.5).half_extents);
    const Convex B = Convex::box(families::random_box(rng, 0.1, 0.5).half_extents);
    Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
    X_WA.linear() = families::rotation(rng);
    X_WB = families::random_pose(rng, 0.0, 0.8);
    WarmStart warm;
    if (!gap_between(A, X_WA, B, X_WB, {}, warm).meets) continue;
    ++overlapping;
    const Depth depth = ExpandingPolytope({A, X_WA, B, X_WB}).run(warm);
    const Depth of_boxes = BoxDepth({A, X_WA, B, X_WB}).run();
    EXPECT_TRUE(depth.closed);
    EXPECT_NEAR(depth.value, of_boxes.value, 1e-14);
    EXPECT_LE(depth.lower, of_boxes.upper);
    EXPECT_GE(depth.upper, of_boxes.lower);
  }
  EXPECT_GT(overlapping, 1000);
}

TEST(ExpandingPolytope, WithManyCornersEndsWithATrueBracket) {
  // Near the centre of two balls of 2000 corners all faces are almost equally near.
  Rng rng(seed);
  const Convex A = Convex::polytope(families::cloud(rng, 2000, 0.5).vertices);
  const Convex B = Convex::polytope(families::cloud(rng, 2000, 0.5).vertices);
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(1e-3, 0, 0);
  WarmStart warm;
  ASSERT_TRUE(gap_between(A, Pose::Identity(), B, X_WB, {}, warm).meets);
  const Pose X_WA = Pose::Identity();
  const Depth depth = ExpandingPolytope({A, X_WA, B, X_WB}).run(warm);
  EXPECT_FALSE(depth.closed);
  EXPECT_LE(depth.iterations, ExpandingPolytope::cap);
  EXPECT_GT(depth.lower, 0.5);
  EXPECT_LT(depth.upper, 1.0);
  EXPECT_LT(depth.lower, depth.upper);
}

TEST(ExpandingPolytope, CornersThatDoNotEncloseTheOriginClaimNothing) {
  const Convex A = Convex::box({1, 1, 1});
  const Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(3, 0, 0);
  const WarmStart apart{{0, 1, 2, 4}, {7, 6, 5, 3}, 4, 0, 0};
  EXPECT_EQ(ExpandingPolytope({A, X_WA, A, X_WB}).run(apart).upper,
            std::numeric_limits<double>::infinity());
  const WarmStart flat{{0, 0, 0, 0}, {7, 7, 7, 7}, 4, 0, 0};
  EXPECT_EQ(ExpandingPolytope({A, X_WA, A, X_WA}).run(flat).upper,
            std::numeric_limits<double>::infinity());
}

}  // namespace expanding_polytope_test
}  // namespace repel::detail
