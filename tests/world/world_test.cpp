// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/world.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>

#include "support/families.hpp"

namespace repel {
namespace world_test {

constexpr unsigned seed = 42;

template <class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no SetupError";
}

bool says(const std::string& message, const std::string& words) {
  return message.find(words) != std::string::npos;
}

TEST(World, HandsOutIdsInOrderAndKeepsWhatItWasGiven) {
  World world;
  const BodyId tool = world.add_body("tool");
  const PartId a = world.add_part(tool, "finger", Shape::sphere(0.01));
  const PartId b = world.add_part(World::fixed, "wall", Shape::box({1, 1, 1}));
  const PairId pair = world.add_pair(a, b, {.range = 0.5});
  EXPECT_EQ(tool.index, 1);
  EXPECT_EQ(a.index, 0);
  EXPECT_EQ(b.index, 1);
  EXPECT_EQ(pair.index, 0);
  EXPECT_EQ(world.body_count(), 2);
  EXPECT_EQ(world.body_name(tool), "tool");
  EXPECT_EQ(world.part(b).name, "wall");
  EXPECT_EQ(world.part(a).body, tool);
  EXPECT_EQ(world.pair(pair).law.range, 0.5);
}

TEST(World, PairIsNoDeeperThanItsShapesCanBe) {
  World world;
  const PartId a = world.add_part(world.add_body("tool"), "finger", Shape::box({0.2, 0.3, 0.1}));
  const PartId b = world.add_part(World::fixed, "tissue", Shape::box({1, 1, 0.5}));
  const ForceLaw law{.ceiling = 5.0, .passable = true};
  EXPECT_NEAR(world.pair(world.add_pair(a, b, law)).law.depth, 0.6, 1e-12);
  ForceLaw shallow = law;
  shallow.depth = 0.25;
  EXPECT_EQ(world.pair(world.add_pair(a, b, shallow)).law.depth, 0.25);
  EXPECT_TRUE(says(message_of([&] { world.add_pair(a, b, {.passable = true}); }), "ceiling"));
}

TEST(World, MeasuresAllOverlapsInOneWayWhichBoundsTheirDepth) {
  EXPECT_EQ(World().query_options().measure, Measure::deepest_point);
  for (const Measure measure : all_measures) {
    World world({}, measure);
    EXPECT_EQ(world.query_options().measure, measure);
    EXPECT_EQ(world.query_options().iterations, QueryOptions{}.iterations);
    const PartId a = world.add_part(world.add_body("tool"), "plate", Shape::box({0.1, 0.1, 0.01}));
    const PartId b = world.add_part(World::fixed, "wall", Shape::box({0.02, 0.3, 0.3}));
    const Pair& pair = world.pair(world.add_pair(a, b, {.ceiling = 5.0, .passable = true}));
    const double inscribed = 0.01 + 0.02;
    EXPECT_NEAR(pair.law.depth, inscribed, 1e-12);
    // Plates that cross are farther from separation than they are thick.
    if (measure == Measure::exact) {
      EXPECT_GT(world.deepest(pair), 0.12);
    } else {
      EXPECT_NEAR(world.deepest(pair), inscribed, 1e-12);
    }
  }
  const std::string refusal = message_of([] { World({}, static_cast<Measure>(7)); });
  EXPECT_TRUE(says(refusal, "measure is 7") && says(refusal, "allowed: 0 to 2")) << refusal;
}

TEST(World, OverAnyLimitNamesTheFieldToRaise) {
  World bodies(Capacities{.bodies = 2});
  bodies.add_body("one");
  EXPECT_TRUE(says(message_of([&] { bodies.add_body("two"); }), "Capacities::bodies"));

  World parts(Capacities{.parts = 1});
  parts.add_part(World::fixed, "one", Shape::sphere(1));
  EXPECT_TRUE(says(message_of([&] { parts.add_part(World::fixed, "two", Shape::sphere(1)); }),
                   "Capacities::parts"));

  World pairs(Capacities{.pairs = 1});
  const PartId a = pairs.add_part(pairs.add_body("tool"), "a", Shape::sphere(1));
  const PartId b = pairs.add_part(World::fixed, "b", Shape::sphere(1));
  pairs.add_pair(a, b, {});
  EXPECT_TRUE(says(message_of([&] { pairs.add_pair(a, b, {}); }), "Capacities::pairs"));
  EXPECT_EQ(pairs.pairs().size(), 1U);
}

TEST(World, RefusesPairsOfOneBodyAndPartsThatDoNotExist) {
  World world;
  const PartId a = world.add_part(World::fixed, "left", Shape::sphere(1));
  const PartId b = world.add_part(World::fixed, "right", Shape::sphere(1));
  const std::string same = message_of([&] { world.add_pair(a, b, {}); });
  EXPECT_TRUE(says(same, "left") && says(same, "right")) << same;
  EXPECT_THROW(world.add_pair(a, PartId{}, {}), SetupError);
  EXPECT_THROW(world.add_pair(PartId{7}, b, {}), SetupError);
  EXPECT_THROW(world.add_part(BodyId{5}, "lost", Shape::sphere(1)), SetupError);
  EXPECT_THROW(world.add_part(BodyId{}, "lost", Shape::sphere(1)), SetupError);
}

TEST(World, RefusesALawThatCannotBeUsed) {
  World world;
  const PartId a = world.add_part(world.add_body("tool"), "a", Shape::sphere(1));
  const PartId b = world.add_part(World::fixed, "b", Shape::sphere(1));
  EXPECT_TRUE(says(message_of([&] { world.add_pair(a, b, {.range = -1.0}); }), "range"));
  EXPECT_TRUE(world.pairs().empty());
}

TEST(World, RefusesPosesAtSetUpThatAreNotRigid) {
  World world;
  Pose X = Pose::Identity();
  X.linear() *= 1.001;
  EXPECT_TRUE(says(message_of([&] { world.add_body("scaled", X); }), "scaled"));
  X = Pose::Identity();
  X.translation().x() = std::nan("");
  EXPECT_THROW(world.add_part(World::fixed, "nowhere", Shape::sphere(1), X), SetupError);
  X = Pose::Identity();
  X.linear()(2, 2) = -1.0;
  EXPECT_THROW(world.add_body("mirrored", X), SetupError);
  EXPECT_EQ(world.body_count(), 1);
}

TEST(World, PlaceKeepsTheOldStateWhenTheNewOneIsNotSound) {
  World world;
  const BodyId tool = world.add_body("tool");
  Pose X = Pose::Identity();
  X.translation() = Vec3(1, 2, 3);
  ASSERT_TRUE(world.place(tool, X, {{1, 0, 0}, {0, 1, 0}}));
  const BodyState before = world.motion().bodies[tool.index];

  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity()};
  int refused = 0;
  for (const double value : bad) {
    for (int entry = 0; entry < 12; ++entry) {
      Pose Y = X;
      Y.matrix()(entry % 3, entry / 3) = value;
      EXPECT_FALSE(world.place(tool, Y, {}));
      ++refused;
    }
    for (int entry = 0; entry < 6; ++entry) {
      Twist V;
      (entry < 3 ? V.linear : V.angular)[entry % 3] = value;
      EXPECT_FALSE(world.place(tool, X, V));
      ++refused;
    }
  }
  Pose scaled = X;
  scaled.linear() *= 1.001;
  EXPECT_FALSE(world.place(tool, scaled, {}));
  Pose mirrored = X;
  mirrored.linear().col(0) *= -1.0;
  EXPECT_FALSE(world.place(tool, mirrored, {}));
  // At 1e15 m no distance can be told: a pair would have none, and the force of a contact.
  Pose far = X;
  far.translation().x() = 1e15;
  EXPECT_FALSE(world.place(tool, far, {}));
  EXPECT_THROW(world.add_body("far", far), SetupError);

  const BodyState& after = world.motion().bodies[tool.index];
  EXPECT_EQ(after.X_WB.matrix(), before.X_WB.matrix());
  EXPECT_EQ(after.V_WB.linear, before.V_WB.linear);
  EXPECT_EQ(after.V_WB.angular, before.V_WB.angular);
  EXPECT_EQ(after.travel, before.travel);
  EXPECT_EQ(after.turn, before.turn);
  EXPECT_EQ(refused, 36);
}

// Distance of the farthest point of a moving body from its start, which the odometer must bound.
TEST(World, OdometersBoundTheMotionOfEveryPointOfABody) {
  families::Rng random(seed);
  for (int run = 0; run < 40; ++run) {
    World world;
    const BodyId body = world.add_body("body");
    std::vector<Vec3> corners;  // in the body frame
    for (int part = 0; part < 3; ++part) {
      const Vec3 h = Vec3(families::uniform(random, 0.0, 0.3), families::uniform(random, 0.0, 0.3),
                          families::uniform(random, 0.0, 0.3));
      Pose X_BP = Pose::Identity();
      X_BP.linear() = families::rotation(random);
      X_BP.translation() = families::uniform(random, 0.0, 0.5) * families::direction(random);
      world.add_part(body, "part", Shape::box(h), X_BP);
      for (const Vec3& v : families::box(h).vertices) corners.push_back(X_BP * v);
    }
    const BodyState& state = world.motion().bodies[body.index];
    Pose X = Pose::Identity();
    Pose X_marked = X;
    double travel = 0.0;
    double turn = 0.0;
    const double largest =
        families::log_uniform(random, 1e-6, 3.0);  // step, from tiny to half turns
    for (int tick = 0; tick < 60; ++tick) {
      if (tick % 20 == 0) {
        X_marked = X;
        travel = state.travel;
        turn = state.turn;
      }
      const double angle = std::min(3.14, families::uniform(random, 0.0, largest));
      X.linear() = families::small_rotation(random, angle) * X.linear();
      X.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
      X.translation() += families::uniform(random, 0.0, largest) * families::direction(random);
      ASSERT_TRUE(world.place(body, X, {}));
      for (const Vec3& p : corners) {
        const double moved = (X * p - X_marked * p).norm();
        ASSERT_LE(moved, state.travel - travel) << "run " << run << ", seed " << seed;
        const double by_turning = (X.linear() * p - X_marked.linear() * p).norm();
        ASSERT_LE(by_turning, state.turn - turn) << "run " << run << ", seed " << seed;
      }
    }
  }
}

TEST(World, OdometersStandStillWithTheBodyButForRounding) {
  World world;
  const BodyId body = world.add_body("body");
  world.add_part(body, "part", Shape::sphere(0.1));
  Pose X = Pose::Identity();
  X.translation().x() = 1.0;
  world.place(body, X, {});
  const double before = world.motion().bodies[body.index].travel;
  EXPECT_GE(before, 1.0);
  for (int i = 0; i < 1000; ++i) world.place(body, X, {});
  EXPECT_LT(world.motion().bodies[body.index].travel - before, 1e-9);
}

}  // namespace world_test
}  // namespace repel
