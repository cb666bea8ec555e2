// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/speed_bounds.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <repel/loop/joint_torques.hpp>

#include "loop/slider.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel {
namespace speed_bounds_test {

using Vector = ArmInertia::Vector;
constexpr unsigned seed = 27;
constexpr double limit = 0.25;     // [m/s]
constexpr double period = 0.0025;  // [s]

/// Three masses on rails along x, y and z: the last has the mass of the first, and so on.
struct Rails : ArmKinematics {
  Rails() {
    for (const double mass : {2.0, 3.0, 5.0}) {
      ArmLink link;
      link.type = JointType::prismatic;
      link.mass = mass;
      model.links.push_back(link);
    }
  }
  void update(std::span<const double> /*q*/) noexcept override {}
  [[nodiscard]] Pose X_WT() const noexcept override { return Pose::Identity(); }
  [[nodiscard]] Pose X_WL(int /*link*/) const noexcept override { return Pose::Identity(); }
  void tool_jacobian(JacobianRef J) const noexcept override { jacobian(2, {0, 0, 0}, J); }
  void jacobian(int link, const Vec3& /*p_WQ*/, JacobianRef J) const noexcept override {
    J.setZero();
    for (int i = 0; i <= link; ++i) J(i, i) = 1.0;
  }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }
  ArmModel model;
};

/// The tool carried by the rails: 10, 8 and 5 kg.
struct DrivenTool : testing::Test {
  Rails rails;
  ArmInertia inertia{rails.model};
  network::Jacobian jacobian = network::Jacobian::Zero(6, 3);
  Vector walls = Vector::Zero(3);

  DrivenTool() {
    for (ArmLink& link : rails.model.links) link.effort_limit = 1e7;
    rails.tool_jacobian(jacobian);
    (void)inertia.update(rails);
  }
  /// [N] Sent for what is asked for.
  std::vector<double> sent(const Vector& v, const Vector& asked, bool carried = false) {
    JointTorques torques(rails.model, period, {});
    said =
        torques.compose(asked, walls, {.friction = 0.0}, {v(0), v(1), v(2)}, inertia,
                        {.tool = {.jacobian = &jacobian, .limit = limit, .is_carried = carried}});
    return torques.torques();
  }
  /// [m/s] after a tick.
  static Vec3 after(const Vector& v, const std::vector<double>& torques) {
    const Vec3 mass(10.0, 8.0, 5.0);
    Vec3 then;
    for (int i = 0; i < 3; ++i) {
      then[i] = v(i) + period * torques[static_cast<std::size_t>(i)] / mass[i];
    }
    return then;
  }
  Status said = 0;
};

TEST_F(DrivenTool, IsNoFasterThanItMayBeWhateverIsAskedFor) {
  families::Rng rng(seed);
  int cut = 0;
  for (int i = 0; i < families::draws(2000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "motion", i));
    Vector v(3), asked(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      v(k) = families::uniform(rng, -0.14, 0.14);
      asked(k) = std::pow(10.0, families::uniform(rng, 0.0, 4.0)) * (rng() % 2 == 0 ? 1.0 : -1.0);
    }
    const std::vector<double> torques = sent(v, asked);
    EXPECT_LE(after(v, torques).norm(), 1.1 * limit);
    const bool is_cut = (said & status::tool_speed) != 0U;
    if (!is_cut) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(torques[k], asked(static_cast<Eigen::Index>(k)));
      }
    }
    cut += is_cut ? 1 : 0;
  }
  EXPECT_GT(cut, families::draws(500));
  EXPECT_LT(cut, families::draws(2000));
}

/// [m] Where a rail gets that is driven at its end by all its effort, with a drive that is late.
double furthest(double rate, int delay, double mass_factor, bool knows_where) {
  Rails rails;
  rails.model.links[0].effort_limit = 400.0;
  rails.model.links[0].lower = -1.0;
  rails.model.links[0].upper = 1.0;
  ArmInertia inertia(rails.model);
  (void)inertia.update(rails);
  JointTorques torques(rails.model, 1.0 / rate, {}, delay);
  std::vector<double> late(static_cast<std::size_t>(delay) + 1, 0.0);
  Vector asked = Vector::Zero(3);
  asked(0) = 400.0;
  std::vector<double> q(3, 0.0), v(3, 0.0);
  double most = 0.0;
  for (int tick = 0; tick < static_cast<int>(2.0 * rate); ++tick) {
    (void)torques.compose(
        asked, Vector::Zero(3), {.friction = 0.0}, v, inertia,
        {.q = knows_where ? std::span<const double>(q) : std::span<const double>()});
    late.insert(late.begin(), torques.torques()[0]);
    v[0] += late.back() / (10.0 * mass_factor) / rate;
    late.pop_back();
    q[0] += v[0] / rate;
    most = std::max(most, q[0]);
  }
  return most;
}

// A joint that ran into the spring ahead of its stop with 2.9 rad/s was thrown back with 2, by a
// drive that was two ticks of 5 ms late.
TEST(SpeedBounds, StopAJointBeforeTheEndOfItsRangeWhateverTheDelay) {
  for (const double rate : {200.0, 1000.0}) {
    for (const int delay : {0, 3}) {
      for (const double mass_factor : {0.6, 1.0, 1.7}) {
        SCOPED_TRACE(std::to_string(rate) + " Hz, delay " + std::to_string(delay) +
                     ", mass times " + std::to_string(mass_factor));
        EXPECT_LE(furthest(rate, delay, mass_factor, true), mass_factor > 1.0 ? 1.04 : 1.002);
        EXPECT_GT(furthest(rate, delay, mass_factor, true), 0.98) << "and lets it get there";
        EXPECT_GT(furthest(rate, delay, mass_factor, false), 2.0) << "the ranges do not count";
      }
    }
  }
}

TEST_F(DrivenTool, ThatIsTooFastIsBrakedAndWhatIsAskedAcrossStays) {
  Vector v = Vector::Zero(3), asked = Vector::Zero(3);
  v(0) = 0.3;
  asked(1) = 2.0;
  const std::vector<double> torques = sent(v, asked);
  EXPECT_LT(torques[0], 0.0);
  EXPECT_NEAR(torques[1], 2.0, 0.5);
  asked(0) = -300.0;
  EXPECT_EQ(sent(v, asked)[0], -300.0) << "who brakes harder may";
}

TEST_F(DrivenTool, AWallThatMovesCarriesItAndAnOperatorDoesNot) {
  Vector v = Vector::Zero(3), asked = Vector::Zero(3);
  v(0) = 0.3;
  walls(0) = 100.0;
  asked(0) = 150.0;
  EXPECT_LT(sent(v, asked)[0], 0.0);
  EXPECT_NEAR(sent(v, asked, true)[0], 100.0, 1e-3);
}

// What a hard wall takes off is shared out by mass, so a light joint gets most of it. It was let go
// by the torque of a stop that the operator withstood, and turned at 80 rad/s.
TEST(SpeedBounds, WallThatTheOperatorWithstandsLetsNoJointGo) {
  Rails rails;
  rails.model.links[0].velocity_limit = 0.2;
  ArmInertia inertia(rails.model);
  (void)inertia.update(rails);
  SpeedBounds speeds(rails.model, 2.0 * period);
  LeastConstraint problem(3, 8);
  const std::vector<double> none(3, 0.0), least(3, -1e6), most(3, 1e6);
  const auto mass = [](Eigen::Index i) { return i == 0 ? 0.01 : i % 4 == 0 ? 1.0 : 0.0; };
  const auto joint_after = [&](const Vector& walls) {
    EXPECT_TRUE(problem.begin(3, mass, period));
    problem.ask(none, none);
    speeds.observe({}, inertia);
    (void)speeds.foresee(problem.mass(), none, none, none, {});
    Vector h = Vector::Zero(3);
    h(0) = h(1) = 1.0;
    problem.add(h, 0.0)->least_rate = 0.5;
    int rounds = 0;
    do {
      (void)problem.solve(least, most);
    } while (rounds++ < 4 && speeds.bound(problem, none, walls, {}));
    EXPECT_NEAR(period * (problem.acceleration()(0) + problem.acceleration()(1)), 0.5, 1e-3);
    return period * problem.acceleration()(0);
  };
  EXPECT_LE(joint_after(Vector::Zero(3)), 0.2);
  Vector withstood = Vector::Zero(3);
  withstood(0) = 100.0;
  EXPECT_LE(joint_after(withstood), 0.2);
}

// A bound that forgets dry friction holds back what has not overcome it yet: an arm stayed 20 mm in
// a wall that pushed it.
TEST_F(DrivenTool, WhatFrictionTakesMovesNothing) {
  Vector v = Vector::Zero(3), asked = Vector::Zero(3);
  asked(0) = 400.0;
  EXPECT_LT(sent(v, asked)[0], 399.0);
  rails.model.links[0].coulomb_friction = 300.0;
  EXPECT_EQ(sent(v, asked)[0], 400.0);
}

/// The greatest speed [m/s] out of a wall, after something has pressed the tool into it with
/// `force` [N] and lets go. @param silent whether the operator is
double thrown_back(double force, bool silent) {
  network::Phase phase;
  phase.duration = 100.0;
  phase.silent = silent;
  test::SliderCell cell({phase}, {.is_touched = true});
  double fastest = 0.0;
  double deepest = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    const TickRecord& record = cell.tick_alone();
    EXPECT_EQ(record.status & status::blind, 0U) << to_text(record.status);
    deepest = std::min(deepest, record.pairs.nearest);
    // The network's spring gives way at 60 N; and hands tremble, or readings would be frozen.
    const double trembling = 1.0 + 0.05 * std::sin(0.3 * tick);
    if (tick < 2000) cell.arm.force[0] += trembling * (force + (silent ? 0.0 : 60.0));
    cell.arm.step(0.0025);
    if (tick >= 2000) fastest = std::max(fastest, -cell.arm.v[0]);
  }
  EXPECT_LT(deepest, 0.0) << "it must have been in the wall";
  EXPECT_LT(cell.arm.q[0], 0.15) << "and is out again";
  return fastest;
}

// The spring of the wall threw it back at twice the speed at which an operator may drive it.
TEST(SpeedBounds, SoftWallThrowsTheToolBackNoFasterThanItMayBeDriven) {
  for (const double force : {120.0, 200.0, 260.0}) {
    for (const bool silent : {false, true}) {
      EXPECT_LT(thrown_back(force, silent), 1.25 * 0.25) << force << " N, silent " << silent;
    }
  }
}

// What a wall has stored is bounded, what it brings by its own motion is not: it would pass.
TEST(SpeedBounds, WallThatMovesFasterPushesTheToolAlong) {
  network::Phase phase;
  phase.duration = 100.0;
  phase.silent = true;
  test::SliderCell cell({phase}, {.door = ReciprocatingMotion{{0.2, 0.0, 0.0}, 1.0}});
  double fastest = 0.0;
  double nearest = 1.0;
  for (int tick = 0; tick < 400; ++tick) {
    const TickRecord& record = cell.tick();
    if (cell.arm.q[0] < 0.1) nearest = std::min(nearest, record.pairs.nearest);
    fastest = std::max(fastest, cell.arm.v[0]);
  }
  RecordProperty("nearest_um", static_cast<int>(1e6 * nearest));
  EXPECT_GT(fastest, 0.4);
  EXPECT_GT(nearest, 0.0025);
}

}  // namespace speed_bounds_test
}  // namespace repel
