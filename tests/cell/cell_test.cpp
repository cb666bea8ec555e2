// SPDX-License-Identifier: BSD-3-Clause
// A cell through its C++ interface: its behaviour.
#include <repel/cell/cell.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include <repel/reduction/shape.hpp>
#include <repel/schedule/world_changes.hpp>

#include "cell/sliders.hpp"

namespace repel {
namespace cell_test {

using test::sliders;

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

// The motion was taken for one of the network: an arm moved by 0.3 m while its controller was off
// was held for five seconds, for an energy that nobody had gained.
TEST(Cell, AnArmThatIsMovedWhileTheLoopStandsGainsNothing) {
  Cell cell(sliders());
  test::SliderArm arm;
  arm.friction = 500.0;
  network::Command hands;
  hands.hand.ball.linear.y() = 0.05;
  std::chrono::nanoseconds now{0};
  Status seen = 0;
  int held = 0;
  for (int tick = 0; tick < 1200; ++tick) {
    if (tick == 400) {
      now += std::chrono::seconds(3);
      arm.q = {-0.2, arm.q[1], 0.2};
      arm.v = {};
    }
    const TickRecord& record = cell.step({arm.q, arm.v}, hands, now += cell.period());
    seen |= record.status;
    if (tick >= 400) held += record.stop == Stop::running ? 0 : 1;
    arm.set_torques(std::span(record.torques).first(3));
    arm.step(0.0025);
  }
  EXPECT_NE(seen & status::clock_gap, 0U);
  EXPECT_EQ(seen & status::energy_gain, 0U);
  EXPECT_LT(held, 400) << "it goes on within a second";
}

/// The cell of the sliders, with a box that can come, and what drives it.
struct LooseBox {
  LooseBox() : cell(description()) { arm.friction = 500.0; }
  static CellDescription description() {
    CellDescription description = sliders();
    Pose X_WP = Pose::Identity();
    X_WP.translation().x() = 0.12;
    description.loose.push_back({"box", Shape::box({0.02, 0.02, 0.02}), X_WP, {}});
    return description;
  }
  /// Moves the hand at `speed` [m/s] along x. Returns the largest step of the force from tick to
  /// tick [N].
  double drive(double speed, double time) {
    network::Command hands;
    hands.hand.ball.linear.x() = speed;
    double largest_step = 0.0;
    for (int tick = 0; tick < time * 400.0; ++tick) {
      record = &cell.step({arm.q, arm.v}, hands, now += cell.period());
      EXPECT_EQ(record->status & status::failsafe, 0U) << to_text(record->status);
      arm.set_torques(std::span(record->torques).first(3));
      arm.step(0.0025);
      largest_step = std::max(largest_step, std::abs(record->virtual_force.force.x() - force));
      force = record->virtual_force.force.x();
    }
    return largest_step;
  }
  Cell cell;
  test::SliderArm arm;
  const TickRecord* record = nullptr;
  std::chrono::nanoseconds now{0};
  double force = 0.0;  // [N] on the tool, along x
};

TEST(Cell, LetsATookPartWorkLikeTheTool) {
  LooseBox box;
  const PartId part = box.cell.loose().front();
  const BodyId tool = box.cell.layout(0).tool;
  EXPECT_LT(box.drive(0.0, 0.1), 1e-12) << "nothing is there";
  // It comes where the ball of the tool is: 0.05 + 0.02 - 0.06 deep.
  ASSERT_TRUE(box.cell.changes().add(part, Pose(Eigen::Translation3d(0.06, 0, 0)), 0.2));
  EXPECT_LT(box.drive(0.0, 0.3), 3.0) << "pushed, not kicked";
  EXPECT_LT(box.force, -1.0);
  EXPECT_LT(box.arm.q[0], -0.001) << "pushed out of it";
  ASSERT_TRUE(box.cell.changes().attach(part, tool, 0.2));
  EXPECT_LT(box.drive(0.0, 0.5), 1.0) << "taken without a kick";
  EXPECT_EQ(box.force, 0.0);
  // Held, it meets the wall before the ball does.
  const double ahead =
      box.cell.world().motion().bodies.back().X_WB.translation().x() + 0.02 - (box.arm.q[0] + 0.05);
  EXPECT_GT(ahead, 0.02);
  EXPECT_LT(box.drive(0.1, 6.0), 3.0);
  EXPECT_LT(box.force, -1.0);
  EXPECT_GT(box.arm.q[0] + ahead, 0.17) << "it must come near the wall, which begins at 0.25 m";
  EXPECT_LT(box.arm.q[0] + ahead, 0.2);
  // Let go there, it is in the way of the ball.
  ASSERT_TRUE(box.cell.changes().release(part, 0.1));
  EXPECT_LT(box.drive(0.0, 0.5), 3.0);
  const double left_at = box.cell.world().motion().bodies.back().X_WB.translation().x();
  EXPECT_LT(box.force, -1.0) << "an obstacle again";
  (void)box.drive(-0.1, 1.0);
  EXPECT_EQ(box.cell.world().motion().bodies.back().X_WB.translation().x(), left_at);
  ASSERT_TRUE(box.cell.changes().remove(part, 0.1));
  (void)box.drive(0.1, 6.0);
  EXPECT_GT(box.arm.q[0], 0.17) << "nothing but the wall";
}

/// The levels of the wall of a cell, which has one when it is built.
int levels_of_wall(const std::function<void(CellDescription&)>& change) {
  CellDescription description = sliders();
  description.obstacles[0].shape = Shape::box({0.1, 1.0, 1.0}, {.levels = 1, .spacing = 2.0});
  change(description);
  const Cell cell(std::move(description));
  EXPECT_EQ(cell.world().query_options().measure, cell.description().measure);
  const Shape& wall = cell.world().parts().back().shape;
  EXPECT_EQ(wall.reduction().spacing, 2.0);
  return wall.reduction().levels;
}

TEST(Cell, BuildsTheLevelsThatItsMeasureNeedsAndNoOthers) {
  EXPECT_EQ(levels_of_wall([](CellDescription& /*cell*/) {}), 1);
  EXPECT_EQ(levels_of_wall([](CellDescription& cell) { cell.levels = 12; }), 1);
  const auto reduced = [](CellDescription& cell) { cell.measure = Measure::reduction; };
  EXPECT_EQ(levels_of_wall(reduced), 1) << "without a number, as the shapes were built";
  const auto with = [](Measure measure, const std::optional<Shape>& other = {}) {
    return [=](CellDescription& cell) {
      cell.measure = measure;
      cell.levels = 12;
      Pose X_WP = Pose::Identity();
      X_WP.translation().x() = -5.0;
      if (!other) return;
      cell.obstacles.insert(cell.obstacles.begin(), ObstacleDescription{"other", *other, X_WP});
    };
  };
  EXPECT_EQ(levels_of_wall(with(Measure::reduction)), 12);
  EXPECT_EQ(levels_of_wall(with(Measure::exact)), 1);
  // Shapes that these measures cannot measure are measured by the levels.
  EXPECT_EQ(levels_of_wall(with(Measure::exact, Shape::cylinder(0.1, 0.1))), 12);
  const Shape flat = Shape::hull(std::vector<Vec3>{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}});
  EXPECT_EQ(levels_of_wall(with(Measure::deepest_point, flat)), 12);
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
