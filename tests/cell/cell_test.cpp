// A cell through its C++ interface: the set-ups it refuses, and its behaviour.
#include <repel/cell/cell.hpp>

#include <gtest/gtest.h>

#include <functional>

#include "loop/slider.hpp"

namespace repel {
namespace cell_test {

using network::Module;

/// A network from a hand to three joints, with these modules before and after the Jacobian.
network::Plan plan_with(const std::vector<Module>& before, const std::vector<Module>& after,
                        int joints = 3) {
  network::Plan plan;
  plan.add("hand", network::FlowSource<network::any_size>(network::Vec<network::any_size>::Zero(6)))
      .add("kbb2", network::Kbb2());
  for (std::size_t i = 0; i < before.size(); ++i) plan.add("wall " + std::to_string(i), before[i]);
  plan.add("puma_kin", network::PumaKin());
  for (std::size_t i = 0; i < after.size(); ++i) plan.add("link " + std::to_string(i), after[i]);
  plan.add("puma_joints", network::PumaJoints(joints));
  return plan;
}

/// Three sliders with enough friction for the wall 0.2 m in front of their ball.
CellDescription sliders() {
  CellDescription cell;
  ArmDescription& arm = cell.arms.emplace_back();
  arm.model = test::slider_model(1000.0);
  for (ArmLink& link : arm.model.links) link.viscous_friction = 500.0;
  arm.kinematics = std::make_unique<test::SliderKinematics>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = 0.35;
  cell.obstacles.push_back({"wall", Shape::box({0.1, 1.0, 1.0}), X_WP, {}});
  return cell;
}

/// Modifies the sliders. @return the error message of the cell; empty if it was built
std::string refusal_of(const std::function<void(CellDescription&)>& change) {
  CellDescription description = sliders();
  change(description);
  try {
    const Cell cell(std::move(description));
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

void expect_refused(const std::function<void(CellDescription&)>& change,
                    const std::vector<std::string>& words) {
  const std::string text = refusal_of(change);
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

TEST(CellRefuses, NothingOfWhatTheTestsBelowBegin) {
  EXPECT_EQ(refusal_of([](CellDescription&) {}), "");
}

// Regression: the tool passed through such a wall with 1487 N in the record and a status of 0.
TEST(CellRefuses, WallsWithoutAModuleThatBringsThem) {
  expect_refused([](CellDescription& cell) { cell.arms[0].network = plan_with({}, {}); },
                 {"obstacles for the tool and no module", "allowed: one like 'obstacle'"});
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].parts.push_back({"rod", Shape::sphere(0.05), Pose::Identity(), 1});
        cell.arms[0].network = plan_with({network::Obstacle()}, {});
      },
      {"links to keep off the obstacles and no module", "allowed: one like 'arm_obstacle'"});
}

TEST(CellRefuses, WallsThatActTwice) {
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].network = plan_with({network::Obstacle(), network::Obstacle()}, {});
      },
      {"'wall 0' and 'wall 1'", "twice", "allowed: one of them"});
}

TEST(CellRefuses, ANetworkThatDoesNotEndInTheArm) {
  expect_refused(
      [](CellDescription& cell) { cell.arms[0].network = plan_with({network::Obstacle()}, {}, 2); },
      {"2 joints", "allowed: a robot (puma_joints) of 3 joints"});
  expect_refused(
      [](CellDescription& cell) {
        const network::Mat<network::any_size> one = network::Mat<network::any_size>::Identity(6, 6);
        network::Plan plan;
        plan.add("mass", network::Mass<network::any_size>(one))
            .add("ball", network::Spaceball())
            .add("end", network::Mass<network::any_size>(one));
        cell.arms[0].network = plan;
        cell.obstacles.clear();
      },
      {"no robot", "allowed: a robot (puma_joints) of 3 joints"});
}

TEST(CellRefuses, GainsOutOfTheirBounds) {
  // Whatever the friction of the arm.
  EXPECT_EQ(refusal_of([](CellDescription& cell) {
              for (ArmLink& link : cell.arms[0].model.links) link.viscous_friction = 0.0;
            }),
            "");
  const auto free_and_weak = [](CellDescription& cell) {
    for (ArmLink& link : cell.arms[0].model.links) link.viscous_friction = 1.0;
    cell.obstacles[0].law.damping = 1.0;
  };
  expect_refused(free_and_weak, {"wall too stiff: 'wall'", "N/m; with its damping of 1 N s/m",
                                 "the limit is", "this wall needs", "in the device, which has 1"});
  expect_refused(
      [&](CellDescription& cell) {
        free_and_weak(cell);
        cell.arms[0].options.drive_delay = 2.0;
      },
      {"wall too stiff", "a drive delay of 2 ticks"});
  expect_refused([](CellDescription& cell) { cell.arms[0].options.drive_delay = 4.0; },
                 {"limits too stiff", "a drive delay of 4 ticks"});
  EXPECT_EQ(refusal_of([&](CellDescription& cell) {
              free_and_weak(cell);
              cell.gain_check = network::GainCheck::warning;
            }),
            "");
  expect_refused([](CellDescription& cell) { cell.obstacles[0].law.range = -1.0; }, {"allowed: "});
  expect_refused([](CellDescription& cell) { cell.rate_hz = 0.0; }, {"rate is 0 Hz; allowed: 1"});
  expect_refused([](CellDescription& cell) { cell.arms[0].options.tool_speed = 100.0; },
                 {"tool speed is 100 m/s"});
}

TEST(CellRefuses, AJointThatMovesNoMass) {
  expect_refused([](CellDescription& cell) { cell.arms[0].model.links[2].rotor_inertia = 0.0; },
                 {"joint 'z' moves no mass", "allowed: links with mass and inertia"});
}

TEST(CellRefuses, AnArmThatIsNotDescribed) {
  expect_refused([](CellDescription& cell) { cell.arms.clear(); }, {"no arm; allowed: 1"});
  expect_refused([](CellDescription& cell) { cell.arms[0].kinematics = nullptr; },
                 {"no kinematics"});
  expect_refused([](CellDescription& cell) { cell.arms[0].model.links.clear(); }, {"no joint"});
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].start = {0.0, 0.0};
      },
      {"2 joints; allowed: 3"});
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].start = {0.0, 11.0, 0.0};
      },
      {"11 for y; allowed: -10 to 10"});
  expect_refused([](CellDescription& cell) { cell.arms[0].parts[0].link = 3; },
                 {"link of part 'ball' is 3", "0 to 2"});
}

TEST(CellRefuses, AStartInsideAWallUnlessItIsToBePushedOut) {
  const auto inside = [](CellDescription& cell) { cell.arms[0].start = {0.25, 0.0, 0.0}; };
  expect_refused(inside, {"'ball' starts inside 'wall'", "start_inside: push_out"});
  for (const StartInside allowed : {StartInside::push_out, StartInside::allow}) {
    CellDescription description = sliders();
    inside(description);
    description.start_inside = allowed;
    const Cell cell(std::move(description));
    ASSERT_EQ(cell.warnings().size(), 1U);
    EXPECT_NE(cell.warnings()[0].find("'ball' starts inside 'wall'"), std::string::npos);
  }
}

/// Kinematics that know only their tool.
struct ToolAlone final : test::SliderKinematics {
  [[nodiscard]] Pose X_WL(int link) const noexcept override { return ArmKinematics::X_WL(link); }
};

TEST(CellRefuses, PartsOnLinksWhosePosesTheKinematicsDoNotGive) {
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].kinematics = std::make_unique<ToolAlone>();
        cell.arms[0].parts.push_back({"rod", Shape::sphere(0.05), Pose::Identity(), 1});
      },
      {"link 'y' has parts", "X_WL"});
}

TEST(Cell, BringsAnArmToAWallAndNoFurtherInOneCallATick) {
  Cell cell(sliders());
  test::SliderArm arm;
  arm.friction = 500.0;
  network::Command hands;
  hands.hand.ball.linear.x() = 0.1;
  std::chrono::nanoseconds now{0};
  double peak = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    const TickRecord& record = cell.step({arm.q, arm.v}, hands, now += cell.period());
    ASSERT_EQ(record.status & status::failsafe, 0U) << to_text(record.status);
    arm.set_torques(std::span(record.torques).first(3));
    arm.step(0.0025);
    peak = std::max(peak, record.virtual_force.force.norm());
  }
  EXPECT_GT(arm.q[0], 0.17) << "the ball must come near the wall, which begins at 0.2 m";
  EXPECT_LT(arm.q[0], 0.2);
  EXPECT_GT(peak, 1.0);
}

TEST(Cell, LetsAnOperatorGoWhoseHandsAreNoNumbersOrMissing) {
  Cell cell(sliders());
  test::SliderArm arm;
  network::Command hands;
  hands.hand.ball.linear.x() = std::numeric_limits<double>::quiet_NaN();
  const TickRecord& record = cell.step({arm.q, arm.v}, hands, cell.period());
  EXPECT_NE(record.status & status::bad_command, 0U);
  EXPECT_TRUE(is_finite(record.command.hand.ball));
  const ArmReadings readings{arm.q, arm.v};
  cell.sense({&readings, 1}, 2 * cell.period());
  EXPECT_NE(cell.act({}).front()->status & status::silent_device, 0U);
  cell.sense({}, 3 * cell.period());
  hands.hand.ball.linear.x() = 0.0;
  EXPECT_NE(cell.act({&hands, 1}).front()->status & status::bad_joints, 0U);
}

TEST(Cell, KeepsTwoArmsOfOneWorldApart) {
  CellDescription description = sliders();
  description.obstacles.clear();
  ArmDescription& second = description.arms.emplace_back();
  second.name = "left";
  second.model = description.arms[0].model;
  second.kinematics = std::make_unique<test::SliderKinematics>();
  second.start = {0.3, 0.0, 0.0};
  second.parts.push_back({"ball", Shape::sphere(0.05)});
  Cell cell(std::move(description));
  EXPECT_EQ(cell.world().body_name(cell.layout(1).tool), "left/tool");
  ASSERT_EQ(cell.world().pairs().size(), 1U);
  std::array<test::SliderArm, 2> arms;
  for (test::SliderArm& arm : arms) arm.friction = 500.0;
  arms[1].q[0] = 0.3;
  std::array<network::Command, 2> hands;
  hands[0].hand.ball.linear.x() = 0.1;
  for (int tick = 1; tick <= 4000; ++tick) {
    const std::array<ArmReadings, 2> readings{ArmReadings{arms[0].q, arms[0].v},
                                              ArmReadings{arms[1].q, arms[1].v}};
    cell.sense(readings, tick * cell.period());
    const auto records = cell.act(hands);
    for (std::size_t i = 0; i < 2; ++i) {
      arms[i].set_torques(std::span(records[i]->torques).first(3));
      arms[i].step(0.0025);
    }
    ASSERT_LT(arms[0].q[0], arms[1].q[0] - 0.1) << "tick " << tick;
  }
  EXPECT_GT(arms[0].q[0], 0.1);
}

}  // namespace cell_test
}  // namespace repel
