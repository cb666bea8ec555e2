#include <repel/network/operator.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const SpaceballOptions direct{.dead_band = 0.0,
                              .saturation = 10.0,
                              .angular_dead_band = 0.0,
                              .angular_saturation = 10.0,
                              .time_constant = 0.0};

Phase ball_phase(double duration, const Vec3& linear, PhaseFrame frame = PhaseFrame::world) {
  Phase phase;
  phase.duration = duration;
  phase.rates.linear = linear;
  phase.frame = frame;
  return phase;
}

Phase lever_phase(double duration, const Vec3& direction, double rate,
                  PhaseFrame frame = PhaseFrame::world) {
  Phase phase;
  phase.master = Master::torque_arm;
  phase.duration = duration;
  phase.direction = direction;
  phase.lever_rate = rate;
  phase.frame = frame;
  return phase;
}

TEST(ScriptedOperator, PhasesLastExactlyTheirTicks) {
  for (const double rate : {400.0, 1000.0}) {
    const std::vector<double> durations{1.0, 0.3, 0.0025, 1.2, 0.7, 0.1, 2.5};
    Script script;
    for (const double duration : durations) script.push_back(ball_phase(duration, {0.1, 0, 0}));
    ScriptedOperator the_operator(script, direct, {});
    std::vector<int> ticks(durations.size(), 0);
    int all = 0;
    while (!the_operator.over() && all < 100000) {
      (void)the_operator.step(Mat3::Identity(), Vec3::Zero(), 1.0 / rate);
      if (!the_operator.over()) ++ticks[the_operator.phase()];
      ++all;
    }
    for (std::size_t i = 0; i < durations.size(); ++i) {
      // A duration between two ticks goes to the nearer one.
      EXPECT_NEAR(ticks[i], durations[i] * rate, 0.5 + 1e-9) << "phase " << i << " at " << rate;
      if (i != 2) {
        EXPECT_EQ(ticks[i], std::lround(durations[i] * rate)) << "phase " << i;
      }
    }
  }
}

TEST(ScriptedOperator, LongPhaseLosesNoTickToRounding) {
  ScriptedOperator the_operator({ball_phase(1000.0, {0.1, 0, 0})}, direct, {});
  int ticks = 0;
  for (; ticks < 2000000; ++ticks) {
    (void)the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.001);
    if (the_operator.over()) break;
  }
  EXPECT_EQ(ticks, 1000000);
}

TEST(ScriptedOperator, RestsWhenTheScriptIsOver) {
  ScriptedOperator the_operator({ball_phase(0.1, {0.1, 0, 0})}, direct, {});
  EXPECT_FALSE(the_operator.over());
  for (int tick = 0; tick < 50; ++tick) {
    (void)the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
  }
  EXPECT_TRUE(the_operator.over());
  EXPECT_EQ(the_operator.phase(), 1U);
  const Command command = the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
  EXPECT_TRUE(command.sound);
  EXPECT_EQ(command.twist.linear, Vec3::Zero());
}

TEST(ScriptedOperator, EmptyScriptIsOverAtOnce) {
  ScriptedOperator the_operator({}, direct, {});
  EXPECT_TRUE(the_operator.over());
  EXPECT_EQ(the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025).twist.linear, Vec3::Zero());
}

TEST(ScriptedOperator, RatesThatAreNotFiniteAreRestAndSaid) {
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    Phase turned = ball_phase(0.1, {0.1, 0, 0});
    turned.rates.angular.y() = bad;
    const Script scripts[] = {{ball_phase(0.1, {bad, 0.1, 0.1})},
                              {turned},
                              {lever_phase(0.1, {1, 0, 0}, bad)},
                              {lever_phase(0.1, {bad, 0, 0}, 1.0)}};
    for (const Script& script : scripts) {
      ScriptedOperator the_operator(script, direct, {});
      for (int tick = 0; tick < 40; ++tick) {
        const Command command = the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
        ASSERT_FALSE(command.sound);
        ASSERT_EQ(command.twist.linear, Vec3::Zero());
        ASSERT_EQ(command.twist.angular, Vec3::Zero());
      }
      EXPECT_TRUE(the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025).sound);
    }
  }
}

TEST(ScriptedOperator, FeltForceThatIsNotFiniteStopsTheLever) {
  ScriptedOperator the_operator({lever_phase(1.0, {1, 0, 0}, 1.0)}, direct, {});
  const Command bad = the_operator.step(Mat3::Identity(), Vec3(0, nan, 0), 0.0025);
  EXPECT_FALSE(bad.sound);
  EXPECT_EQ(bad.twist.linear, Vec3::Zero());
  const Command good = the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
  EXPECT_TRUE(good.sound);
  EXPECT_TRUE(is_finite(good.twist));
}

TEST(ScriptedOperator, DirectionsAreThoseOfTheFrameThePhaseNames) {
  const Mat3 R_WT = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();  // x to y
  for (const PhaseFrame frame : {PhaseFrame::world, PhaseFrame::tool}) {
    const Vec3 expected = frame == PhaseFrame::world ? Vec3::UnitX() : Vec3::UnitY();
    ScriptedOperator ball({ball_phase(1.0, {0.1, 0, 0}, frame)}, direct, {});
    const Vec3 by_ball = ball.step(R_WT, Vec3::Zero(), 0.0025).twist.linear;
    EXPECT_LE((by_ball - 0.1 * expected).norm(), 1e-15);

    ScriptedOperator lever({lever_phase(1.0, {1, 0, 0}, 1.0, frame)}, direct, {});
    const Vec3 by_lever = lever.step(R_WT, Vec3::Zero(), 0.0025).twist.linear;
    EXPECT_GT(by_lever.norm(), 0.0);
    EXPECT_LE(by_lever.cross(expected).norm(), 1e-15);
  }
}

TEST(ScriptedOperator, LeverPushesBackWithTheForceOnTheTool) {
  ScriptedOperator the_operator({lever_phase(10.0, {0, 0, 1}, 0.5)}, direct, {});
  for (int tick = 0; tick < 400; ++tick) {
    (void)the_operator.step(Mat3::Identity(), {3.0, 4.0, -20.0}, 0.0025);
  }
  EXPECT_NEAR(the_operator.lever().felt(), -2.0, 1e-12);  // 0.1 m times 20 N
}

TEST(ScriptedOperator, EachPhaseTakesUpTheLeverAnew) {
  ScriptedOperator the_operator(
      {lever_phase(0.5, {1, 0, 0}, 2.0), lever_phase(0.5, {0, 1, 0}, 0.0)}, direct, {});
  for (int tick = 0; tick < 200; ++tick) {
    (void)the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
  }
  EXPECT_GT(the_operator.lever().angle(), 0.5);
  (void)the_operator.step(Mat3::Identity(), Vec3::Zero(), 0.0025);
  EXPECT_EQ(the_operator.lever().angle(), 0.0);
}

}  // namespace
}  // namespace repel::network
