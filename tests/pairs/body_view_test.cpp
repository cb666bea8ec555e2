// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/body_view.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace body_view_test {

constexpr unsigned seed = 6120;

TEST(BodyView, BoxHoldsWhateverTheBoxOfTheOtherBodyHolds) {
  families::Rng random(seed);
  double widest = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Pose X_WA = test::random_pose(random, 10.0);
    Pose X_WB = test::random_pose(random, 10.0);
    // As rigid as World::place requires.
    X_WB.linear() *= 1.0 + families::uniform(random, -1e-7, 1e-7);
    Box box(Vec3(0.3 * families::direction(random)));
    box.extend(Vec3(0.3 * families::direction(random)));
    const Box seen = BodyView(X_WA, X_WB).box(box);
    for (int corner = 0; corner < 8; ++corner) {
      const auto end = [&](int axis) { return (corner >> axis & 1) != 0 ? box.max() : box.min(); };
      const Vec3 p_A(end(0).x(), end(1).y(), end(2).z());
      const Vec3 p_B = X_WB.linear().inverse() * (X_WA * p_A - X_WB.translation());
      ASSERT_TRUE(seen.contains(p_B)) << families::of_seed(seed, "sample", i);
    }
    widest = std::max(widest, extents(seen).norm() / extents(box).norm());
  }
  EXPECT_GT(widest, 1.2);
  EXPECT_LT(widest, 2.0);
}

TEST(BodyView, LowerBoundIsNoMoreThanTheDistanceInTheWorld) {
  families::Rng random(seed);
  for (int i = 0; i < 500; ++i) {
    const Pose X_WA = test::random_pose(random, 10.0);
    Pose X_WB = test::random_pose(random, 10.0);
    X_WB.linear() *= 1.0 + families::uniform(random, -1e-7, 1e-7);
    const Vec3 p_B = families::uniform(random, 0.1, 5.0) * families::direction(random);
    const double in_world = (X_WB.linear() * p_B).norm();
    EXPECT_LE(BodyView(X_WA, X_WB).lower_bound(p_B.norm()), in_world);
    EXPECT_GE(BodyView(X_WA, X_WB).lower_bound(p_B.norm()), (1.0 - 1e-6) * in_world);
  }
}

}  // namespace body_view_test
}  // namespace repel::detail
