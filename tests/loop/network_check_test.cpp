#include <repel/loop/network_check.hpp>

#include <gtest/gtest.h>

#include "loop/slider.hpp"

namespace repel {
namespace network_check_test {

constexpr double period = 0.0025;  // [s]

/// A ball and a link on rails, and a wall for each that is asked for.
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

/// From a hand to three joints, with these modules before and after the Jacobian.
network::Network network_with(const std::vector<network::Module>& before,
                              const std::vector<network::Module>& after, int joints = 3) {
  network::Plan plan;
  plan.add("hand", network::FlowSource<network::any_size>(network::Vec<network::any_size>::Zero(6)))
      .add("kbb2", network::Kbb2());
  for (std::size_t i = 0; i < before.size(); ++i) plan.add("wall " + std::to_string(i), before[i]);
  plan.add("puma_kin", network::PumaKin());
  for (std::size_t i = 0; i < after.size(); ++i) plan.add("link " + std::to_string(i), after[i]);
  return plan.add("puma_joints", network::PumaJoints(joints)).build(period);
}

std::string complaint(const network::Network& network, const Scene& scene, int joints = 3) {
  try {
    require_complete(network, joints, scene.world, scene.tool, scene.links);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

void expect_says(const std::string& text, const std::string& what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
  EXPECT_NE(text.find("allowed: "), std::string::npos) << text;
}

// The tool once went through such a wall with 1487 N in the record and a status of 0.
TEST(NetworkCheck, WallsNeedAModuleThatBringsThem) {
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

TEST(NetworkCheck, WallsThatActTwiceAreRefused) {
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

TEST(NetworkCheck, ItEndsInTheArm) {
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

// The check stands where an arm is put together, so no program can forget it.
TEST(NetworkCheck, ATeleoperatorIsNotBuiltWithoutIt) {
  Scene scene(true, false);
  const ArmModel model = test::slider_model(1000.0);
  test::SliderArm arm;
  test::SliderKinematics kinematics;
  Coprocessor coprocessor(scene.world, {});
  network::ScriptedOperator hands({});
  const auto built = [&](network::Network network) {
    Teleoperator teleoperator(model, arm, kinematics, scene.world, scene.tool, coprocessor, hands,
                              std::move(network), test::SliderCell::period);
    return teleoperator.network().nodes().size();
  };
  EXPECT_THROW((void)built(network_with({}, {})), SetupError);
  EXPECT_EQ(built(network_with({network::Obstacle()}, {})), 5U);
}

}  // namespace network_check_test
}  // namespace repel
