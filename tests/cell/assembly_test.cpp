// SPDX-License-Identifier: BSD-3-Clause
// What a cell refuses, through its C++ interface.
#include <repel/cell/assembly.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <repel/cell/cell.hpp>

#include "cell/sliders.hpp"

namespace repel {
namespace assembly_test {

using test::plan_with;
using test::sliders;

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
  EXPECT_EQ(refusal_of([&](CellDescription& cell) {
              free_and_weak(cell);
              cell.arms[0].options.drive_delay = 4.0;
              cell.obstacles[0].law.damping_may_rise = true;
            }),
            "");
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

TEST(CellRefuses, AMeasureOrLevelsOutOfRange) {
  expect_refused([](CellDescription& cell) { cell.measure = static_cast<Measure>(3); },
                 {"measure is 3", "allowed: 0 to 2"});
  for (const int levels : {0, -1, 65}) {
    // Also where the measure needs none.
    for (const Measure measure : all_measures) {
      expect_refused(
          [&](CellDescription& cell) {
            cell.measure = measure;
            cell.levels = levels;
          },
          {"levels is " + std::to_string(levels), "allowed: 1 to 64"});
    }
  }
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
  // More than there is storage for: its Jacobian was written past the end before anything checked.
  expect_refused(
      [](CellDescription& cell) { cell.arms[0].model.links.resize(network::most_joints + 1); },
      {"17 joints; allowed: 1 to 16"});
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].start = {0.0, 0.0};
      },
      {"2 joints; allowed: 3"});
  expect_refused(
      [](CellDescription& cell) {
        cell.arms[0].start = {0.0, 11.0, 0.0};
      },
      {"11 m for y; allowed: -10 to 10 m"});
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

}  // namespace assembly_test
}  // namespace repel
