// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/speed_share.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "loop/slider.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel {
namespace speed_share_test {

TEST(SpeedShare, LeavesTheToolAloneUpToTheLimit) {
  for (const double speed : {0.0, 0.1, 0.25}) {
    EXPECT_EQ(speed_share(speed, 0.25).drive, 1.0);
    EXPECT_EQ(speed_share(speed, 0.25).brake, 0.0);
  }
}

TEST(SpeedShare, DrivesNoMoreAndBrakesBeyondAFifthMore) {
  EXPECT_NEAR(speed_share(0.275, 0.25).drive, 0.5, 1e-12);
  EXPECT_EQ(speed_share(0.275, 0.25).brake, 0.0);
  EXPECT_NEAR(speed_share(0.3, 0.25).drive, 0.0, 1e-12);
  EXPECT_NEAR(speed_share(0.3375, 0.25).brake, 0.5, 1e-12);
  EXPECT_EQ(speed_share(10.0, 0.25).drive, 0.0);
  EXPECT_EQ(speed_share(10.0, 0.25).brake, 1.0);
}

TEST(SpeedShare, NeverDrivesAndBrakesAtOnce) {
  for (double speed = 0.0; speed < 1.0; speed += 0.001) {
    const SpeedShare share = speed_share(speed, 0.25);
    EXPECT_NEAR(share.drive * share.brake, 0.0, 1e-12) << speed;
  }
}

TEST(SpeedShare, WallsGiveBackNoneOfTheirForceBeyondAFifthMore) {
  EXPECT_EQ(release_share(0.0, 0.25, 1e9), 1.0) << "at rest they push as they are";
  EXPECT_EQ(release_share(0.125, 0.25, 1e9), 1.0);
  EXPECT_NEAR(release_share(0.25, 0.25, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(release_share(0.275, 0.25, 0.0), 0.5, 1e-12);
  EXPECT_NEAR(release_share(0.3, 0.25, 0.0), 0.0, 1e-12);
  for (const double growth : {0.0, 0.1, 1.0, 100.0}) {
    for (double speed = 0.13; speed < 0.3; speed += 0.01) {
      const double then = speed * (1.0 + growth * release_share(speed, 0.25, growth));
      EXPECT_LE(then, 0.3 + 1e-12) << speed << ", growth " << growth;
    }
  }
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
TEST(SpeedShare, SoftWallThrowsTheToolBackNoFasterThanItMayBeDriven) {
  for (const double force : {120.0, 200.0, 260.0}) {
    for (const bool silent : {false, true}) {
      EXPECT_LT(thrown_back(force, silent), 1.25 * 0.25) << force << " N, silent " << silent;
    }
  }
}

// What a wall has stored is bounded, what it brings by its own motion is not: it would pass.
TEST(SpeedShare, WallThatMovesFasterPushesTheToolAlong) {
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

TEST(SpeedShare, AHandWhoseNumbersAreNoneRestsWhereItsLeverPointed) {
  network::HandInput last;
  last.direction_W = Vec3::UnitY();
  network::HandInput hand;
  hand.ball.linear = Vec3(0.1, 0, 0);
  EXPECT_TRUE(rest_unless_finite(hand, last));
  EXPECT_EQ(hand.ball.linear.x(), 0.1);
  hand.turning_W.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rest_unless_finite(hand, last));
  EXPECT_EQ(hand.ball.linear, Vec3::Zero());
  EXPECT_EQ(hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(hand.turning_W, Vec3::Zero());
}

TEST(SpeedShare, NoHandLeadsFasterThanTheToolMayBe) {
  network::HandInput hand;
  hand.ball.linear = Vec3(0.0, 0.1, 0.0);
  hand.lever_rate = 1.0;
  EXPECT_FALSE(cut_to_speed(hand, 0.25, 0.1));
  EXPECT_EQ(hand.ball.linear, Vec3(0.0, 0.1, 0.0));
  EXPECT_EQ(hand.lever_rate, 1.0);
  for (const double huge : {10.0, 1e300}) {
    hand.ball.linear = Vec3(0.0, huge, 0.0);
    hand.lever_rate = -huge;
    hand.direction_W = Vec3(huge, 0.0, 0.0);
    EXPECT_TRUE(cut_to_speed(hand, 0.25, 0.1));
    EXPECT_NEAR(hand.ball.linear.y(), 0.25, 1e-12);
    EXPECT_EQ(hand.lever_rate, -2.5);
    EXPECT_NEAR(hand.direction_W.x(), 1.0, 1e-12);
  }
  hand.direction_W = Vec3(0.0, 2.0, 0.0);
  hand.turning_W = Vec3(0.0, 10.0, 0.0);
  (void)cut_to_speed(hand, 0.25, 0.1);
  EXPECT_EQ(hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(hand.turning_W, Vec3(0.0, 5.0, 0.0)) << "the same screw";
  hand.lever_rate = 2.0;
  hand.scale = 2.0;  // the tool moves twice as far as the lever's scale says
  EXPECT_TRUE(cut_to_speed(hand, 0.25, 0.1));
  EXPECT_EQ(hand.lever_rate, 1.25);
  hand.scale = std::numeric_limits<double>::quiet_NaN();
  (void)cut_to_speed(hand, 0.25, 0.1);
  EXPECT_EQ(hand.scale, 1.0);
}

TEST(CutToSpeed, EachHandByTheScaleOfItsLever) {
  using namespace network;
  const Network levers =
      Plan()
          .add("left", TorqueArm())
          .add("across", Multiplex({.velocity_scale = 0.1, .force_scale = 0.1}))
          .add("left_grip", Relief({.compliant = {true, true, true, true, true, true}}), "tool")
          .add("right", TorqueArm({.hand = Hand::second}))
          .add("down", Multiplex({.velocity_scale = 0.5, .force_scale = 0.5, .hand = Hand::second}))
          .add("right_grip", Relief({.compliant = {true, true, true, true, true, true}}), "tool")
          .add("tool", Junction())
          .add("ground", Ground())
          .build(0.0025);
  const LeverScales scales = lever_scales(levers);
  EXPECT_EQ(scales.first, 0.1);
  EXPECT_EQ(scales.second, 0.5);
  Signals signals;
  signals.hand.lever_rate = signals.second.lever_rate = 1.0;
  EXPECT_TRUE(cut_to_speed(signals, 0.25, scales));
  EXPECT_EQ(signals.hand.lever_rate, 1.0);
  EXPECT_EQ(signals.second.lever_rate, 0.5);
  const Network without = Plan().add("hand", SixAxes()).add("ground", Ground()).build(0.0025);
  EXPECT_EQ(lever_scales(without).second, 1.0);
}

using Vector = ArmInertia::Vector;
constexpr unsigned seed = 27;
constexpr double horizon = 0.015, limit = 0.25;

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

struct DrivenSpeed : testing::Test {
  Rails rails;
  ArmInertia inertia{rails.model};
  network::Jacobian jacobian = network::Jacobian::Zero(6, 3);

  DrivenSpeed() {
    rails.tool_jacobian(jacobian);
    (void)inertia.update(rails);
  }
  /// [m/s] after the horizon, with this share of the torques. The rails carry each other: 10, 8
  /// and 5 kg.
  [[nodiscard]] static double speed_after(const Vector& v, const Vector& torques, double share) {
    const Vec3 mass(10.0, 8.0, 5.0);
    Vec3 then;
    for (int i = 0; i < 3; ++i) then[i] = v(i) + share * horizon * torques(i) / mass[i];
    return then.norm();
  }
  [[nodiscard]] double share(const Vector& v, const Vector& torques) const {
    return share_within(jacobian, v, torques, inertia, horizon, limit);
  }
};

TEST_F(DrivenSpeed, IsTheGreatestShareThatKeepsTheLimit) {
  families::Rng rng(seed);
  int cut = 0;
  for (int i = 0; i < families::draws(2000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "motion", i));
    Vector v(3), torques(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      v(k) = families::uniform(rng, -0.14, 0.14);
      torques(k) = std::pow(10.0, families::uniform(rng, 0.0, 6.0)) * (rng() % 2 == 0 ? 1.0 : -1.0);
    }
    const double s = share(v, torques);
    ASSERT_GE(s, 0.0);
    ASSERT_LE(s, 1.0);
    EXPECT_LE(speed_after(v, torques, s), limit * (1.0 + 1e-9));
    if (s < 1.0) {
      EXPECT_NEAR(speed_after(v, torques, s), limit, 1e-6);
    }
    cut += s < 1.0 ? 1 : 0;
  }
  EXPECT_GT(cut, families::draws(1000));
}

TEST_F(DrivenSpeed, AToolThatIsTooFastIsNotDrivenOnButMayBeHeldBack) {
  const Vector v = Vector::Constant(3, 0.2);
  EXPECT_EQ(share(v, Vector::Constant(3, 1.0)), 0.0);
  EXPECT_EQ(share(v, Vector::Constant(3, -1.0)), 1.0);
}

TEST_F(DrivenSpeed, AtRestNothingIsHeldBackAndWithoutAMassNothingIsKnown) {
  EXPECT_EQ(share(Vector::Zero(3), Vector::Zero(3)), 1.0);
  EXPECT_EQ(share(Vector::Constant(3, 0.1), Vector::Constant(3, std::nan(""))), 1.0);
}

}  // namespace speed_share_test
}  // namespace repel
