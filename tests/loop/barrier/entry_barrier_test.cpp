// SPDX-License-Identifier: BSD-3-Clause
// A hard wall: what no hand can push an arm into.
#include <repel/loop/barrier/entry_barrier.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <repel/cell/cell.hpp>

#include "cell/sliders.hpp"

namespace repel {
namespace entry_barrier_test {

struct Setting {
  double rate = 400.0;  // [Hz]
  double mass = 5.0;    // [kg] of the true arm; the model has 5
  double delay = 0.0;   // [ticks] of its drive
  HoldKind hold = HoldKind::hard;
};

/// A wall at 0.2 m before the ball in x and one in y, whose springs are next to nothing.
CellDescription corner(const Setting& setting) {
  CellDescription cell = test::sliders();
  cell.rate_hz = setting.rate;
  cell.arms[0].options.drive_delay = setting.delay;
  ForceLaw& law = cell.obstacles[0].law;
  law.surface_force = 2.0;
  law.damping_may_rise = true;
  law.hold = setting.hold;
  Pose X = Pose::Identity();
  X.translation().y() = 0.35;
  cell.obstacles.push_back({"side", Shape::box({1.0, 0.1, 1.0}), X, law});
  return cell;
}

/// Drives a cell with three rails, whose drive is late.
struct Driven {
  Driven(CellDescription description, const Setting& setting)
      : cell(std::move(description)), late(static_cast<std::size_t>(setting.delay) + 1) {
    arm.mass = setting.mass;
    arm.friction = 400.0;  // the model has 500
  }
  const TickRecord& tick(const Vec3& rates) {
    network::Command hands;
    hands.hand.ball.linear = rates;
    const TickRecord& record = cell.step({arm.q, arm.v}, hands, now += cell.period());
    late.insert(late.begin(), {record.torques[0], record.torques[1], record.torques[2]});
    late.pop_back();
    arm.set_torques(late.back());
    arm.step(1e-9 * static_cast<double>(cell.period().count()));
    return record;
  }
  Cell cell;
  test::SliderArm arm;
  std::vector<std::array<double, 3>> late;
  std::chrono::nanoseconds now{0};
};

/// Pushes to and fro at random, most of all into the corner. Returns the least gap [m].
/// @param margin least of what was proven [m]
double push(const Setting& setting, Status& seen, double& withstood, double& margin) {
  Driven driven(corner(setting), setting);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  double least = 1.0;
  Vec3 rates(0, 0, 0);
  const auto ticks = static_cast<int>(20.0 * setting.rate);
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick % static_cast<int>(0.4 * setting.rate) == 0) {
      rates = 0.15 * Vec3(1, 1, 0) + 0.6 * Vec3(draw(random), draw(random), draw(random));
    }
    const double gap = std::min(0.2 - driven.arm.q[0], 0.2 - driven.arm.q[1]);
    const TickRecord& record = driven.tick(rates);
    seen |= record.status;
    least = std::min(least, gap);
    if (std::isfinite(record.hold.margin)) {
      EXPECT_LE(record.hold.margin, gap + 1e-9);
    }
    EXPECT_EQ(record.hold.left_out, 0);
    margin = std::min(margin, record.hold.margin);
  }
  withstood = std::max(driven.cell.withstood({0}), driven.cell.withstood({1}));
  for (const network::Node& node : driven.cell.network(0).nodes()) {
    if (node.traits.passive && !node.traits.measures_flow) {
      EXPECT_LE(node.ledger.deficit(), 1e-9) << node.name;
    }
  }
  return least;
}

// A wall was a spring: the hand pushed the ball two metres through it.
TEST(EntryBarrier, NoHandEntersAHardWall) {
  for (const double rate : {200.0, 400.0, 1000.0, 4000.0}) {
    for (const double mass : {3.0, 5.0, 8.5}) {
      for (const double delay : {0.0, 2.0}) {
        SCOPED_TRACE(std::to_string(rate) + " Hz, " + std::to_string(mass) + " kg, delay of " +
                     std::to_string(delay));
        Status seen = 0;
        double withstood = 0.0;
        double margin = 1.0;
        const double least = push({rate, mass, delay}, seen, withstood, margin);
        EXPECT_GT(least, -1e-4);
        EXPECT_LT(least, 2e-3) << "it must come to the wall";
        EXPECT_GT(withstood, 50.0) << "N: and be pushed against it";
        EXPECT_GE(margin, 0.0) << "m: it could be stopped at any time";
        EXPECT_LT(margin, 1e-3) << "m: and the proof is not of what is far";
        EXPECT_EQ(seen & (status::failsafe | status::hold_lost), 0U) << to_text(seen);
      }
    }
  }
}

// The push was counted as far as torques may change in a tick: 157 N at 400 Hz, 16 at 4 kHz. And
// the status spoke of torques that were cut while they stood still.
TEST(EntryBarrier, ThePushThatAWallWithstandsDoesNotDependOnTheTick) {
  for (const double rate : {400.0, 1000.0, 4000.0}) {
    const Setting setting{.rate = rate};
    Driven driven(corner(setting), setting);
    const auto ticks = static_cast<int>(4.0 * rate);
    int cut = 0;
    double held = 0.0;
    double asked = 0.0;
    for (int tick = 0; tick < ticks; ++tick) {
      const TickRecord& record = driven.tick({0.2, 0.0, 0.0});
      if (tick < ticks / 2) continue;
      cut += (record.status & status::torque_rate) != 0U ? 1 : 0;
      held = record.held_force;
      asked = record.coupling.force.x();
    }
    EXPECT_GT(asked, 40.0) << rate << " Hz";
    EXPECT_NEAR(held, asked, 0.2 * asked) << rate << " Hz";
    EXPECT_LT(cut, ticks / 100) << rate << " Hz";
  }
}

TEST(EntryBarrier, ASoftWallIsEnteredByTheSameHand) {
  Status seen = 0;
  double withstood = 0.0;
  double margin = std::numeric_limits<double>::infinity();
  EXPECT_LT(push({.hold = HoldKind::soft}, seen, withstood, margin), -0.5);
  EXPECT_EQ(withstood, 0.0);
  EXPECT_EQ(margin, std::numeric_limits<double>::infinity()) << "m: of nothing hard, nothing";
}

TEST(EntryBarrier, SlidingAlongAWallThatIsPushedCostsNoSpeed) {
  const auto way = [](HoldKind hold, double into) {
    const Setting setting{.hold = hold};
    CellDescription description = corner(setting);
    description.obstacles.pop_back();
    for (ArmLink& link : description.arms[0].model.links) link.viscous_friction = 50.0;
    Driven driven(std::move(description), setting);
    driven.arm.friction = 50.0;  // the hand must not need all its force for it
    for (int tick = 0; tick < 800; ++tick) (void)driven.tick({into, 0.0, 0.0});
    // At its limit the coupling lags behind where the hand goes, whatever is in the way.
    for (int tick = 0; tick < 350; ++tick) (void)driven.tick({-0.1 * into, 0.0, 0.0});
    const double pushed = driven.tick({0.0, 0.0, 0.0}).coupling.force.x();
    EXPECT_NEAR(pushed, hold == HoldKind::hard ? 50.0 : 0.0, 5.0);
    const double from = driven.arm.q[1];
    for (int tick = 0; tick < 800; ++tick) (void)driven.tick({0.0, 0.1, 0.0});
    return driven.arm.q[1] - from;
  };
  const double free = way(HoldKind::soft, 0.0);
  EXPECT_GT(free, 0.1);
  EXPECT_NEAR(way(HoldKind::hard, 0.2), free, 0.02 * free);
}

TEST(EntryBarrier, RetreatIsFree) {
  const auto retreat = [](HoldKind hold) {
    const Setting setting{.hold = hold};
    CellDescription description = corner(setting);
    description.obstacles[0].law.surface_force = 0.0;
    Driven driven(std::move(description), setting);
    for (int tick = 0; tick < 290; ++tick) (void)driven.tick({0.2, 0.0, 0.0});
    const double from = driven.arm.q[0];
    EXPECT_GT(from, 0.05);
    for (int tick = 0; tick < 400; ++tick) (void)driven.tick({-0.2, 0.0, 0.0});
    return driven.arm.q[0] - from;
  };
  EXPECT_NEAR(retreat(HoldKind::hard), retreat(HoldKind::soft), 1e-9);
}

/// A door of which a side comes at the ball.
CellDescription door(double speed) {
  CellDescription cell = corner({});
  cell.obstacles.pop_back();
  ObstacleDescription& wall = cell.obstacles[0];
  wall.motion.emplace();
  wall.motion->along_W = Vec3(-0.6, 0, 0);
  wall.motion->duration = 0.6 * 3.14159265 / speed;
  return cell;
}

TEST(EntryBarrier, AnArmFleesFromAWallThatComes) {
  const Setting setting;
  Driven driven(door(0.15), setting);
  double least = 1.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const TickRecord& record = driven.tick({0.0, 0.0, 0.0});
    EXPECT_EQ(record.status & status::hold_lost, 0U);
    const auto extremes = driven.cell.coprocessor().extremes_of({0});
    least = std::min(least, extremes.nearest);
  }
  EXPECT_GT(least, -1e-4);
  EXPECT_LT(driven.arm.q[0], -0.3) << "it was pushed away";
}

TEST(EntryBarrier, SaysBeforeTheWallIsReachedThatItCannotHold) {
  const Setting setting;
  CellDescription description = door(6.0);
  for (ArmLink& link : description.arms[0].model.links) link.effort_limit = 100.0;
  Driven driven(std::move(description), setting);
  double told_at = -1.0;  // [m] gap
  double least = 1.0;
  for (int tick = 0; tick < 60; ++tick) {
    const TickRecord& record = driven.tick({0.0, 0.0, 0.0});
    least = driven.cell.coprocessor().separation_of({0}).distance;
    const bool is_lost = (record.status & status::hold_lost) != 0U;
    if (is_lost && told_at < 0.0) told_at = least;
  }
  EXPECT_GT(told_at, 0.005) << "m before it";
  EXPECT_GT(driven.cell.coprocessor().extremes_of({0}).deepest, 1e-3) << "and it was right";
}

}  // namespace entry_barrier_test
}  // namespace repel
