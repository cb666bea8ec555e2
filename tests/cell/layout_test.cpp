// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/layout.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace layout_test {

/// A ball on every link and on the tool, 1 m apart along x, all within range of each other.
ArmDescription chain() {
  ArmDescription arm;
  arm.name = "left";
  arm.model = test::slider_model(1000.0);
  arm.kinematics = std::make_unique<test::SliderKinematics>();
  const auto at = [](double x) {
    Pose X = Pose::Identity();
    X.translation().x() = x;
    return X;
  };
  arm.parts = {{"tip", Shape::sphere(0.1), at(3.0)},
               {"base", Shape::sphere(0.1), at(0.0), 0},
               {"middle", Shape::sphere(0.1), at(1.0), 1},
               {"end", Shape::sphere(0.1), at(2.0), 2}};
  arm.self_law.emplace();
  detail::start(arm);
  return arm;
}

TEST(Layout, PutsPartsOnToolAndLinksUnderTheNameOfTheArm) {
  World world;
  const ArmDescription arm = chain();
  const ArmLayout layout = detail::add_arm(world, arm);
  EXPECT_EQ(world.body_name(layout.tool), "left/tool");
  ASSERT_EQ(layout.links.size(), 3U);
  EXPECT_EQ(world.body_name(layout.links[1].body), "left/y");
  EXPECT_EQ(layout.links[1].link, 1);
  EXPECT_EQ(world.part(layout.parts[3]).name, "left/end");
  EXPECT_EQ(world.part(layout.parts[3]).body, layout.links[2].body);
}

TEST(Layout, KeepsOwnPartsApartThatTwoJointsOrMorePart) {
  const auto pairs_of = [](const ArmDescription& arm) {
    World world;
    detail::add_own_pairs(world, arm, detail::add_arm(world, arm));
    std::vector<std::string> pairs;
    for (const Pair& pair : world.pairs()) {
      pairs.push_back(world.part(pair.a).name + " " + world.part(pair.b).name);
    }
    return pairs;
  };
  ArmDescription arm = chain();
  const std::vector<std::string> all{"left/tip left/base", "left/base left/end"};
  EXPECT_EQ(pairs_of(arm), all);
  arm.may_touch = {{1, 0}};
  EXPECT_EQ(pairs_of(arm), std::vector<std::string>{"left/base left/end"});
  arm.may_touch = {};
  arm.parts[3].X_FP = arm.parts[1].X_FP;
  EXPECT_THROW((void)pairs_of(arm), SetupError) << "they meet at the start";
  arm.self_law.reset();
  EXPECT_TRUE(pairs_of(arm).empty());
}

TEST(Layout, AnObstacleThatMovesIsABodyOfItsOwn) {
  World world;
  const std::vector<ArmLayout> arms{detail::add_arm(world, chain())};
  ObstacleDescription obstacle{"box", Shape::sphere(0.1)};
  EXPECT_FALSE(detail::add_obstacle(world, obstacle, arms));
  EXPECT_EQ(world.parts().back().body, World::fixed);
  obstacle.motion = ReciprocatingMotion{Vec3::UnitX(), 2.0};
  const auto moving = detail::add_obstacle(world, obstacle, arms);
  ASSERT_TRUE(moving);
  EXPECT_EQ(world.parts().back().body, moving->body);
  EXPECT_EQ(world.pairs().size(), 8U);
  obstacle.motion->duration = 0.0;
  EXPECT_THROW((void)detail::add_obstacle(world, obstacle, arms), SetupError);
}

TEST(Layout, NamesTheFirstOverlapsAndCountsTheOthers) {
  const std::vector<std::string> overlaps{"1", "2", "3", "4", "5", "6", "7"};
  try {
    detail::require_clear_start(overlaps);
    FAIL();
  } catch (const SetupError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("1, 2, 3, 4, 5, and 2 more; allowed"), std::string::npos) << text;
  }
  detail::require_clear_start({});
}

}  // namespace layout_test
}  // namespace repel
