// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/separations.hpp>

#include <gtest/gtest.h>

#include <array>

#include <repel/reduction/separation.hpp>

namespace repel {
namespace separations_test {

const Shape ball = Shape::sphere(0.1);
const Shape block = Shape::box({0.2, 0.1, 0.3});

Pose at(double x) {
  Pose X = Pose::Identity();
  X.translation().x() = x;
  return X;
}

TEST(Separations, EachIsThatOfItsPairAlone) {
  const Pose X_WBlock = Pose::Identity();
  const std::array<Pose, 3> X_WBall{at(0.5), at(0.31), at(0.25)};
  std::vector<PosedShapes> pairs;
  for (const Pose& X : X_WBall) pairs.push_back({{ball, X}, {block, X_WBlock}});
  std::array<WarmStart, 3> warm;
  std::array<Separation, 3> found;
  separations(pairs, {}, warm, found);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    WarmStart cold;
    const Separation alone = separation(ball, X_WBall[i], block, X_WBlock, {}, cold);
    EXPECT_EQ(found[i].distance, alone.distance);
    EXPECT_EQ(found[i].p_WA, alone.p_WA);
    EXPECT_GT(warm[i].size, 0);
  }
  EXPECT_NEAR(found[0].distance, 0.2, 1e-12);
}

TEST(Separations, WhatIsMissingOnOneSideIsNotAsked) {
  const Pose X_WBlock = Pose::Identity();
  const Pose X_WBall = at(0.5);
  const std::array<PosedShapes, 2> pairs{PosedShapes{{ball, X_WBall}, {block, X_WBlock}},
                                         PosedShapes{{ball, X_WBall}, {block, X_WBlock}}};
  std::array<WarmStart, 1> warm;
  std::array<Separation, 2> found;
  separations(pairs, {}, warm, found);
  EXPECT_EQ(found[0].end, QueryEnd::converged);
  EXPECT_EQ(found[1].end, QueryEnd::bad_input);
  separations({}, {}, {}, {});
}

}  // namespace separations_test
}  // namespace repel
