// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/near_answer.hpp>

#include <gtest/gtest.h>

namespace repel::detail {
namespace near_answer_test {

TEST(NearAnswer, PlaneThatSeparatesMovesWithTheBodies) {
  NearAnswer answer;
  answer.gradient.force = {0, 0, 1};
  answer.bound = 0.01;
  answer.is_apart = true;
  const MotionSince up{{0, 0, 0.002}, 0.0}, aside{{0.5, 0, 0}, 0.0}, turned{{0, 0, 0}, 0.003};
  EXPECT_NEAR(bound_after(answer, up, {}), 0.012, 1e-15);
  EXPECT_NEAR(bound_after(answer, {}, up), 0.008, 1e-15);
  EXPECT_NEAR(bound_after(answer, up, up), 0.01, 1e-15);
  EXPECT_NEAR(bound_after(answer, aside, {}), 0.01, 1e-15);
  EXPECT_NEAR(bound_after(answer, turned, turned), 0.004, 1e-15);
}

TEST(NearAnswer, InOverlapEveryMotionCounts) {
  NearAnswer answer;
  answer.gradient.force = {0, 0, 1};
  answer.bound = -0.01;
  const MotionSince up{{0, 0, 0.002}, 0.0};
  EXPECT_NEAR(bound_after(answer, up, {}), -0.012, 1e-15);
  EXPECT_NEAR(bound_after(answer, {}, up), -0.012, 1e-15);
}

TEST(MotionSince, IsTheDifferenceOfTwoStates) {
  BodyState then, now;
  then.turn = 1.0;
  now.turn = 1.5;
  now.X_WB.translation() = Vec3(0.1, 0.2, 0.3);
  const MotionSince since = MotionSince::between(then, now);
  EXPECT_EQ(since.moved, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(since.turn, 0.5);
}

}  // namespace near_answer_test
}  // namespace repel::detail
