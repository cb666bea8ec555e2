// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/loose_parts.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <repel/world/world.hpp>

namespace repel {
namespace {

constexpr double dt = 1.0 / 400.0;  // [s]

Pose at(double x, double y = 0.0, double z = 0.0) {
  return Pose(Eigen::Translation3d(x, y, z));
}

/// A tool, and a part that can come and go.
struct Hand {
  Hand() {
    tool = world.add_body("tool");
    (void)world.add_part(tool, "finger", Shape::sphere(0.01));
    world.join(tool, tool);
    world.spare_held(tool);
    part = world.reserve("bottle", Shape::box({0.02, 0.02, 0.05}), 0.1);
  }
  void tick(const Pose& X_WT = Pose::Identity(), const Twist& V_WT = {}) {
    world.advance(dt);
    EXPECT_TRUE(world.place(tool, X_WT, V_WT));
    world.carry();
  }
  [[nodiscard]] const BodyState& body() const {
    return world.motion().bodies[static_cast<std::size_t>(world.part(part).body.index)];
  }
  World world;
  BodyId tool;
  PartId part;
};

TEST(LooseParts, AreAbsentUntilTheyCome) {
  Hand hand;
  EXPECT_FALSE(hand.world.is_there(hand.part));
  EXPECT_FALSE(hand.world.move(hand.part, at(1), 1.0));
  EXPECT_FALSE(hand.world.attach(hand.part, hand.tool, 0.1));
  EXPECT_FALSE(hand.world.release(hand.part, 0.1));
  EXPECT_FALSE(hand.world.remove(hand.part, 0.1));
  EXPECT_TRUE(hand.world.add(hand.part, at(1), 0.1));
  EXPECT_TRUE(hand.world.is_there(hand.part));
  EXPECT_FALSE(hand.world.add(hand.part, at(1), 0.1)) << "it is there";
  for (int k = 0; k < 20; ++k) hand.tick();
  EXPECT_NEAR(hand.body().presence.there.now, 0.5, 1e-9);
  for (int k = 0; k < 20; ++k) hand.tick();
  EXPECT_EQ(hand.body().presence.there.now, 1.0);
  EXPECT_EQ(hand.body().presence.there.rate, 0.0);
}

TEST(LooseParts, RefuseWhatMakesNoSense) {
  Hand hand;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pose bent = at(0);
  bent.linear() *= 2.0;
  EXPECT_FALSE(hand.world.add(hand.part, at(nan), 0.1));
  EXPECT_FALSE(hand.world.add(hand.part, bent, 0.1));
  EXPECT_FALSE(hand.world.add(hand.part, at(0), nan));
  EXPECT_FALSE(hand.world.add(hand.part, at(0), -1.0));
  EXPECT_FALSE(hand.world.add({0}, at(0), 0.1)) << "the finger is no such part";
  EXPECT_FALSE(hand.world.add({-1}, at(0), 0.1));
  EXPECT_FALSE(hand.world.add({99}, at(0), 0.1));
  ASSERT_TRUE(hand.world.add(hand.part, at(0), 0.0));
  EXPECT_FALSE(hand.world.move(hand.part, bent, 1.0));
  EXPECT_FALSE(hand.world.move(hand.part, at(1), nan));
  EXPECT_FALSE(hand.world.move(hand.part, at(1), 0.0));
  EXPECT_FALSE(hand.world.attach(hand.part, World::fixed, 0.1)) << "no tool";
  EXPECT_FALSE(hand.world.attach(hand.part, {99}, 0.1));
  EXPECT_FALSE(hand.world.attach(hand.part, hand.world.part(hand.part).body, 0.1));
  EXPECT_FALSE(hand.world.remove(hand.part, nan));
  ASSERT_TRUE(hand.world.attach(hand.part, hand.tool, 0.1));
  EXPECT_FALSE(hand.world.attach(hand.part, hand.tool, 0.1)) << "it is taken";
  EXPECT_FALSE(hand.world.move(hand.part, at(1), 1.0)) << "it is taken";
}

TEST(LooseParts, AreOfferedAShapeOnlyWhileAbsentAndWithRoomForIt) {
  Hand hand;
  Shape large = Shape::sphere(0.11);
  EXPECT_FALSE(hand.world.refit(hand.part, large));
  Shape fits = Shape::sphere(0.09);
  EXPECT_TRUE(hand.world.refit(hand.part, fits));
  EXPECT_EQ(hand.world.part(hand.part).shape.reach(), 0.09);
  EXPECT_NEAR(fits.reach(), std::sqrt(2 * 0.02 * 0.02 + 0.05 * 0.05), 1e-12) << "the old one";
  ASSERT_TRUE(hand.world.add(hand.part, at(0), 0.0));
  EXPECT_FALSE(hand.world.refit(hand.part, fits));
  EXPECT_THROW((void)hand.world.reserve("too small", Shape::sphere(0.2), 0.1), SetupError);
}

TEST(LooseParts, MoveAtTheirSpeedAndSaySo) {
  Hand hand;
  ASSERT_TRUE(hand.world.add(hand.part, at(0), 0.0));
  Pose there = at(0.1);
  there.linear() = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix();
  ASSERT_TRUE(hand.world.move(hand.part, there, 0.25));
  Pose before = hand.body().X_WB;
  const double travelled = hand.body().travel;
  int moving = 0;
  for (int k = 0; k < 400; ++k) {
    hand.tick();
    const double step = (hand.body().X_WB.translation() - before.translation()).norm();
    EXPECT_LE(step, 0.25 * dt);
    if (hand.body().V_WB.linear.norm() > 0.0 && step > 0.0) {
      EXPECT_NEAR(step / dt, hand.body().V_WB.linear.norm(), 1e-9);
      ++moving;
    }
    before = hand.body().X_WB;
  }
  // 0.1 m and 0.5 rad at a reach of 0.1 m, at 0.25 m/s: 0.6 s.
  EXPECT_NEAR(moving, 240, 2);
  EXPECT_TRUE(hand.body().X_WB.isApprox(there, 1e-12));
  EXPECT_EQ(hand.body().V_WB.linear.norm(), 0.0);
  EXPECT_GE(hand.body().travel - travelled, 0.1);
}

TEST(LooseParts, GoWhereTheirToolGoes) {
  Hand hand;
  const auto tool_at = [](double angle) {
    Pose X = at(std::cos(angle), std::sin(angle));
    X.linear() = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    return X;
  };
  hand.tick(tool_at(0.0));
  ASSERT_TRUE(hand.world.add(hand.part, at(1.2), 0.0));
  ASSERT_TRUE(hand.world.attach(hand.part, hand.tool, 0.05));
  for (int k = 0; k < 19; ++k) hand.tick(tool_at(0.0));
  EXPECT_FALSE(hand.body().arm.valid()) << "first it stops being an obstacle";
  for (int k = 0; k < 40; ++k) hand.tick(tool_at(0.0));
  EXPECT_EQ(hand.body().arm, hand.tool);
  const Twist V_WT{Vec3(0, 0.1, 0), Vec3(0, 0, 0.1)};
  for (int k = 1; k <= 100; ++k) hand.tick(tool_at(0.01 * k), V_WT);
  const Vec3 p = hand.body().X_WB.translation();
  EXPECT_NEAR((p - Vec3(1.2 * std::cos(1.0), 1.2 * std::sin(1.0), 0)).norm(), 0.0, 1e-9);
  EXPECT_GT(hand.body().V_WB.linear.norm(), 0.0);
  ASSERT_TRUE(hand.world.release(hand.part, 0.05));
  for (int k = 0; k < 100; ++k) hand.tick(tool_at(1.0 + 0.01 * k), V_WT);
  const Vec3 left = hand.body().X_WB.translation();
  EXPECT_FALSE(hand.body().arm.valid());
  EXPECT_EQ(hand.body().V_WB.linear.norm(), 0.0);
  for (int k = 0; k < 100; ++k) hand.tick(tool_at(2.0 + 0.01 * k), V_WT);
  EXPECT_EQ((hand.body().X_WB.translation() - left).norm(), 0.0) << "it stays where it was let go";
  EXPECT_FALSE(hand.body().presence.holder.valid());
}

}  // namespace
}  // namespace repel
