// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/teleoperator_parts.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace teleoperator_parts_test {

constexpr double period = 0.0025;  // [s]

/// A ball and a link on rails, optionally with a wall for each.
struct Scene {
  Scene(bool wall_for_tool, bool wall_for_link) {
    const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.05));
    const PartId rod = world.add_part(link, "rod", Shape::sphere(0.05));
    Pose X = Pose::Identity();
    X.translation().x() = 1.0;
    const PartId wall = world.add_part(World::fixed, "wall", Shape::box({0.1, 1.0, 1.0}), X);
    if (wall_for_tool) world.add_pair(ball, wall, {});
    if (wall_for_link) world.add_pair(rod, wall, {});
    links.push_back({link, 1});
  }

  World world;
  BodyId tool = world.add_body("tool");
  BodyId link = world.add_body("link");
  std::vector<LinkBody> links;
};

network::Network network_with(const std::vector<network::Module>& before,
                              const std::vector<network::Module>& after, int joints = 3) {
  return test::plan_with(before, after, joints).build(period);
}

std::string complaint(const network::Network& network, Scene scene) {
  const ArmModel model = test::slider_model(1000.0);
  test::SliderKinematics kinematics;
  try {
    require_complete({model, kinematics, scene.world, scene.tool, scene.links, network});
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

void expect_says(const std::string& text, const std::string& what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
  EXPECT_NE(text.find("allowed: "), std::string::npos) << text;
}

// Regression: the tool passed through such a wall with 1487 N in the record and a status of 0.
TEST(TeleoperatorParts, WallsNeedAModuleThatBringsThem) {
  const network::Network none = network_with({}, {});
  expect_says(complaint(none, Scene(true, false)), "obstacles for the tool and no module");
  expect_says(complaint(none, Scene(false, true)), "links to keep off the obstacles and no module");
  EXPECT_EQ(complaint(none, Scene(false, false)), "");
  const network::Network tool = network_with({network::Obstacle()}, {});
  EXPECT_EQ(complaint(tool, Scene(true, false)), "");
  expect_says(complaint(tool, Scene(true, true)), "arm_obstacle");
  const network::Network both = network_with({network::Obstacle()}, {network::ArmObstacle()});
  EXPECT_EQ(complaint(both, Scene(true, true)), "");
  EXPECT_EQ(complaint(both, Scene(false, false)), "");
}

TEST(TeleoperatorParts, WallsThatActTwiceAreRefused) {
  const Scene scene(true, true);
  const std::string tool = complaint(
      network_with({network::Obstacle(), network::Obstacle()}, {network::ArmObstacle()}), scene);
  expect_says(tool, "'wall 0' and 'wall 1'");
  expect_says(tool, "twice");
  const std::string links =
      complaint(network_with({network::Obstacle()},
                             {network::ArmObstacle(), network::Visual(), network::ArmObstacle()}),
                scene);
  expect_says(links, "'link 0' and 'link 2'");
}

TEST(TeleoperatorParts, ItEndsInTheArm) {
  const Scene scene(false, false);
  expect_says(complaint(network_with({}, {}, 2), scene), "2 joints; allowed: a robot");
  const network::Mat<network::any_size> one = network::Mat<network::any_size>::Identity(6, 6);
  const network::Network no_arm = network::Plan()
                                      .add("mass", network::Mass<network::any_size>(one))
                                      .add("ball", network::Spaceball())
                                      .add("end", network::Mass<network::any_size>(one))
                                      .build(period);
  expect_says(complaint(no_arm, scene), "no robot");
}

}  // namespace teleoperator_parts_test
}  // namespace repel
