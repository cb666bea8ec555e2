// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_answer.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_answer_test {

constexpr unsigned seed = 733;

/// Two parts on two moving bodies, and the result of their evaluation.
struct Two {
  World world;
  BodyId a, b;

  Two(const Shape& A, const Pose& X_AP, const Shape& B, const Pose& X_BP) {
    a = world.add_body("a");
    b = world.add_body("b");
    world.add_pair(world.add_part(a, "part", A, X_AP), world.add_part(b, "part", B, X_BP), {});
  }
  [[nodiscard]] const BodyState& state(BodyId id) const { return world.motion().bodies[id.index]; }
  [[nodiscard]] Separation now() const { return test::separation_now(world, world.pair({0})); }
  [[nodiscard]] double deepest() const {
    return world.parts()[0].shape.deepest() + world.parts()[1].shape.deepest();
  }
  [[nodiscard]] PairAnswer answer() const {
    PairAnswer answer;
    answer.last = now();
    answer.p_BA_W = state(a).X_WB.translation() - state(b).X_WB.translation();
    answer.turn = state(a).turn + state(b).turn;
    answer.tick = 0;
    return answer;
  }
  [[nodiscard]] double lower_bound(const PairAnswer& answer) const {
    return answer.lower_bound(state(a), state(b));
  }
  void move(BodyId id, const Vec3& p, const Mat3& R = Mat3::Identity()) {
    Pose X = state(id).X_WB;
    X.linear() = Eigen::Quaterniond(R * X.linear()).normalized().toRotationMatrix();
    X.translation() += p;
    world.place(id, X, {});
  }
};

TEST(PairAnswer, ProvesTheLowerBoundWhileApartAndTheMeasureInOverlap) {
  PairAnswer answer;
  EXPECT_FALSE(answer.known());
  answer.last.end = QueryEnd::converged;
  answer.last.distance = 0.25;
  answer.last.lower = 0.2;
  EXPECT_EQ(answer.proven(), 0.2);
  answer.last.distance = -0.1;
  answer.last.lower = -0.3;
  EXPECT_EQ(answer.proven(), -0.1);
  answer.last.end = QueryEnd::budget_spent;
  EXPECT_EQ(answer.proven(), -0.3);
}

TEST(PairAnswer, OnlyMotionAlongTheWayOutCountsWhileApart) {
  const Shape cube = Shape::box({0.1, 0.1, 0.1});
  Two two(cube, Pose::Identity(), cube, Pose::Identity());
  two.move(two.a, {0.0, 0.0, 0.25});
  const PairAnswer answer = two.answer();
  EXPECT_NEAR(two.lower_bound(answer), 0.05, 1e-12);
  two.move(two.a, {0.05, 0.02, 0.0});
  EXPECT_NEAR(two.lower_bound(answer), 0.05, 1e-12);
  two.move(two.b, {0.0, 0.0, -0.01});
  EXPECT_NEAR(two.lower_bound(answer), 0.06, 1e-12);
  two.move(two.a, {0.0, 0.0, -0.03});
  EXPECT_NEAR(two.lower_bound(answer), 0.03, 1e-12);
  two.move(two.a, {0.0, 0.0, -10.0});
  EXPECT_NEAR(two.lower_bound(answer), 0.03 - 10.0, 1e-12) << "deeper than any answer";
}

TEST(PairAnswer, InOverlapEveryMotionCounts) {
  const Shape cube = Shape::box({0.1, 0.1, 0.1});
  Two two(cube, Pose::Identity(), cube, Pose::Identity());
  two.move(two.a, {0.0, 0.0, 0.18});
  const PairAnswer answer = two.answer();
  EXPECT_NEAR(two.lower_bound(answer), -0.02, 1e-12);
  two.move(two.a, {0.0, 0.0, 0.01});
  EXPECT_NEAR(two.lower_bound(answer), -0.03, 1e-12);
}

TEST(PairAnswer, BoundIsNeverMoreThanTheDistance) {
  families::Rng random(seed);
  int from_apart = 0, from_overlap = 0, positive = 0, deepest = 0;
  for (int run = 0; run < 400; ++run) {
    SCOPED_TRACE(families::of_seed(seed, "run", run));
    Two two(test::random_shape(random), test::random_pose(random, 0.1), test::random_shape(random),
            test::random_pose(random, 0.1));
    two.move(two.a, 0.1 * families::direction(random), families::rotation(random));
    const PairAnswer answer = two.answer();
    (answer.last.lower > 0.0 ? from_apart : from_overlap) += 1;
    for (int step = 0; step < 20; ++step) {
      for (const BodyId id : {two.a, two.b}) {
        two.move(id, families::uniform(random, 0.0, 0.004) * families::direction(random),
                 families::small_rotation(random, families::uniform(random, 0.0, 0.02)));
      }
      const Separation now = two.now();
      // No answer is deeper than `deepest`: a bound that is may be raised to it.
      const double bound = std::max(two.lower_bound(answer), -two.deepest());
      ASSERT_LE(bound, (now.distance > 0.0 ? now.upper : now.distance) + 1e-12);
      positive += bound > 0.0 ? 1 : 0;
      deepest += bound == -two.deepest() ? 1 : 0;
    }
  }
  // The sample is meaningful: both kinds occur, and the bounds are not trivial.
  EXPECT_GT(from_apart, 100);
  EXPECT_GT(from_overlap, 40);
  EXPECT_GT(positive, 1000);
  EXPECT_GT(deepest, 40);
}

}  // namespace pair_answer_test
}  // namespace repel::detail
