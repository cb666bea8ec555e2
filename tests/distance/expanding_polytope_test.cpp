// SPDX-License-Identifier: BSD-3-Clause
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

struct Hulls {
  Convex A, B;
  Pose X_WA, X_WB;
  WarmStart meeting{};  ///< corners that enclose the origin

  [[nodiscard]] Depth depth(WarmStart& warm) const noexcept {
    return ExpandingPolytope({A, X_WA, B, X_WB}).run(warm);
  }
};

Hulls overlapping_hulls(Rng& rng) {
  while (true) {
    Hulls hulls{Convex::polytope(families::cloud(rng, 16, 0.5).vertices),
                Convex::polytope(families::cloud(rng, 16, 0.5).vertices), Pose::Identity(),
                families::random_pose(rng, 0.0, 0.8)};
    hulls.X_WA.linear() = families::rotation(rng);
    if (gap_between(hulls.A, hulls.X_WA, hulls.B, hulls.X_WB, {}, hulls.meeting).meets)
      return hulls;
  }
}

void expect_same(const Depth& warm, const Depth& cold) {
  EXPECT_EQ(warm.closed, cold.closed);
  EXPECT_NEAR(warm.value, cold.value, 4e-15);
  EXPECT_LE(warm.lower, cold.upper);
  EXPECT_GE(warm.upper, cold.lower);
}

TEST(ExpandingPolytope, ThatOfTheLastTickProvesTheNextDepth) {
  Rng rng(seed);
  int ticks = 0;
  int at_once = 0;
  int unknown = 0;
  for (int i = 0; i < 200; ++i) {
    Hulls hulls = overlapping_hulls(rng);
    WarmStart warm = hulls.meeting;
    const Vec3 heading = families::direction(rng);
    for (int tick = 0; tick < 40; ++tick) {
      SCOPED_TRACE(families::of_seed(seed, "pair", i) + ", tick " + std::to_string(tick));
      WarmStart cold;
      if (!gap_between(hulls.A, hulls.X_WA, hulls.B, hulls.X_WB, {}, cold).meets) break;
      const Depth depth = hulls.depth(warm);
      ++ticks;
      if (depth.upper < std::numeric_limits<double>::infinity()) {
        expect_same(depth, hulls.depth(cold));
      } else {
        // The origin has left the polytope, and is not between four fixed directions either.
        ++unknown;
        warm = cold;
      }
      at_once += depth.iterations == 1 ? 1 : 0;
      hulls.X_WB.translation() += 5e-4 * heading;
      hulls.X_WB.linear() = families::small_rotation(rng, 2e-3) * hulls.X_WB.linear();
    }
  }
  EXPECT_GT(ticks, 6000) << "seed " << seed;
  EXPECT_LT(unknown, 0.01 * ticks) << "seed " << seed;
  EXPECT_GT(at_once, 0.8 * ticks) << "seed " << seed;
}

TEST(ExpandingPolytope, AnyOtherOneClaimsNothing) {
  Rng rng(seed);
  std::uniform_int_distribution<std::uint32_t> any;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const Hulls hulls = overlapping_hulls(rng);
    WarmStart cold = hulls.meeting;
    const Depth truth = hulls.depth(cold);
    if (cold.level_a != WarmStart::exact_depth) continue;
    // Faces that are missing, doubled or turned around, corners of another pair, or any bits.
    WarmStart warm = cold;
    const std::size_t faces = 2U * cold.size - 4U;
    std::uint16_t& face = warm.faces[any(rng) % faces];
    switch (i % 5) {
      case 0:
        face = warm.faces[any(rng) % faces];
        break;
      case 1:
        face = static_cast<std::uint16_t>((face & 15U) << 4U | (face >> 4U & 15U) |
                                          (face & 15U << 8U));
        break;
      case 2:
        warm.b[any(rng) % 4] = any(rng);
        break;
      case 3:
        for (std::uint16_t& f : warm.faces) f = static_cast<std::uint16_t>(any(rng));
        break;
      default:
        warm.size = static_cast<std::uint8_t>(any(rng));
    }
    const Depth depth = hulls.depth(warm);
    // Where nothing is left of it, four fixed directions may not enclose the origin.
    if (depth.upper < std::numeric_limits<double>::infinity()) expect_same(depth, truth);
  }
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
  WarmStart apart{{0, 1, 2, 4}, {7, 6, 5, 3}, 4, 0, 0};
  EXPECT_EQ(ExpandingPolytope({A, X_WA, A, X_WB}).run(apart).upper,
            std::numeric_limits<double>::infinity());
  WarmStart flat{{0, 0, 0, 0}, {7, 7, 7, 7}, 4, 0, 0};
  EXPECT_EQ(ExpandingPolytope({A, X_WA, A, X_WA}).run(flat).upper,
            std::numeric_limits<double>::infinity());
}

}  // namespace expanding_polytope_test
}  // namespace repel::detail
