// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/operator.hpp>

#include <gtest/gtest.h>

#include <vector>

#include <cmath>

#include "support/families.hpp"

namespace repel::network {
namespace operator_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
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
    ScriptedOperator the_operator(script);
    std::vector<int> ticks(durations.size(), 0);
    int all = 0;
    while (!the_operator.over() && all < 100000) {
      (void)the_operator.step(Mat3::Identity(), 1.0 / rate);
      if (!the_operator.over()) ++ticks[the_operator.phase()];
      ++all;
    }
    for (std::size_t i = 0; i < durations.size(); ++i) {
      // A duration between two ticks is rounded to the nearest one.
      EXPECT_NEAR(ticks[i], durations[i] * rate, 0.5 + 1e-9) << "phase " << i << " at " << rate;
      if (i != 2) {
        EXPECT_EQ(ticks[i], std::lround(durations[i] * rate)) << "phase " << i;
      }
    }
  }
}

TEST(ScriptedOperator, LongPhaseLosesNoTickToRounding) {
  ScriptedOperator the_operator({ball_phase(1000.0, {0.1, 0, 0})});
  int ticks = 0;
  for (; ticks < 2000000; ++ticks) {
    (void)the_operator.step(Mat3::Identity(), 0.001);
    if (the_operator.over()) break;
  }
  EXPECT_EQ(ticks, 1000000);
}

TEST(ScriptedOperator, RestsWhenTheScriptIsOver) {
  ScriptedOperator the_operator({ball_phase(0.1, {0.1, 0, 0})});
  EXPECT_FALSE(the_operator.over());
  for (int tick = 0; tick < 50; ++tick) {
    (void)the_operator.step(Mat3::Identity(), 0.0025);
  }
  EXPECT_TRUE(the_operator.over());
  EXPECT_EQ(the_operator.phase(), 1U);
  const Command command = the_operator.step(Mat3::Identity(), 0.0025);
  EXPECT_TRUE(command.sound);
  EXPECT_EQ(command.hand.ball.linear, Vec3::Zero());
}

TEST(ScriptedOperator, EmptyScriptIsOverAtOnce) {
  ScriptedOperator the_operator({});
  EXPECT_TRUE(the_operator.over());
  EXPECT_EQ(the_operator.step(Mat3::Identity(), 0.0025).hand.ball.linear, Vec3::Zero());
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
      ScriptedOperator the_operator(script);
      for (int tick = 0; tick < 40; ++tick) {
        const Command command = the_operator.step(Mat3::Identity(), 0.0025);
        ASSERT_FALSE(command.sound);
        ASSERT_EQ(command.hand.ball.linear, Vec3::Zero());
        ASSERT_EQ(command.hand.ball.angular, Vec3::Zero());
      }
      EXPECT_TRUE(the_operator.step(Mat3::Identity(), 0.0025).sound);
    }
  }
}

TEST(ScriptedOperator, DirectionsAreThoseOfTheFrameThePhaseNames) {
  const Mat3 R_WT = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();  // x to y
  for (const PhaseFrame frame : {PhaseFrame::world, PhaseFrame::tool}) {
    const Vec3 expected = frame == PhaseFrame::world ? Vec3::UnitX() : Vec3::UnitY();
    ScriptedOperator ball({ball_phase(1.0, {0.1, 0, 0}, frame)});
    const Vec3 by_ball = ball.step(R_WT, 0.0025).hand.ball.linear;
    EXPECT_LE((by_ball - 0.1 * expected).norm(), 1e-15);

    ScriptedOperator lever({lever_phase(1.0, {1, 0, 0}, 1.0, frame)});
    const HandInput& hand = lever.step(R_WT, 0.0025).hand;
    EXPECT_LE((hand.direction_W - expected).norm(), 1e-15);
    EXPECT_EQ(hand.lever_rate, 1.0);
  }
}

TEST(Screw, MovesTheFasterOfTwoPointsByTheScaleOfTheLever) {
  // About an axis through the tool: a point 0.1 m off it.
  const Twist turn = Screw{}.per_motion(Vec3::UnitZ());
  EXPECT_EQ(turn.linear, Vec3::Zero());
  EXPECT_EQ(turn.angular, Vec3(0, 0, 10));
  const Twist fine = Screw{.pitch = 0.01}.per_motion(Vec3::UnitZ());
  EXPECT_NEAR(fine.linear.z(), 0.1, 1e-15);
  EXPECT_NEAR(fine.angular.z(), 10.0, 1e-12);
  // Steep, or far off: the tool itself.
  EXPECT_NEAR(Screw{.pitch = -2.0}.per_motion(Vec3::UnitX()).linear.norm(), 1.0, 1e-15);
  const Twist far = Screw{.axis = Vec3(0.5, 0, 0)}.per_motion(Vec3::UnitZ());
  EXPECT_NEAR((far.linear - Vec3(0, -1, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(far.angular.z(), 2.0, 1e-15);
}

// A tool that follows exactly, from any orientation.
TEST(ScriptedOperator, AScrewKeepsTheToolOnItsAxis) {
  constexpr unsigned seed = 8;
  constexpr double period = 0.0025, lever_scale = 0.1;
  families::Rng rng(seed);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "screw", i));
    const PhaseFrame frame = i % 2 == 0 ? PhaseFrame::world : PhaseFrame::tool;
    const Vec3 a = families::direction(rng);
    const Screw screw{.pitch = families::uniform(rng, -0.05, 0.05),
                      .axis = families::uniform(rng, 0.0, 0.2) * families::direction(rng)};
    Phase phase = lever_phase(2.0, a, 1.0, frame);
    phase.screw = screw;
    ScriptedOperator the_operator({phase});
    Pose X(Eigen::AngleAxisd(families::uniform(rng, 0.0, 3.0), families::direction(rng)));
    const Mat3 R_WF = frame == PhaseFrame::tool ? Mat3(X.linear()) : Mat3(Mat3::Identity());
    const Vec3 a_W = R_WF * a, axis_W = R_WF * screw.axis;
    const double off = axis_W.cross(a_W).norm();
    double angle = 0.0;
    for (int tick = 0; tick < 800; ++tick) {
      const HandInput& hand = the_operator.step(X.linear(), period).hand;
      ASSERT_LE(hand.direction_W.norm(), 1.0 + 1e-12);
      ASSERT_LE((hand.turning_W.normalized() - a_W).norm(), 1e-9);
      const double step = period * lever_scale * hand.lever_rate;
      // By the middle of the period, to second order.
      const Mat3 half(Eigen::AngleAxisd(0.5 * step * hand.turning_W.norm(), a_W));
      X.translation() += step * (half * hand.direction_W);
      X.linear() = half * half * X.linear();
      angle += step * hand.turning_W.norm();
    }
    EXPECT_NEAR((X.translation() - axis_W).cross(a_W).norm(), off, 1e-4);
    EXPECT_NEAR(X.translation().dot(a_W), screw.pitch * angle, 1e-6);
    EXPECT_GT(angle, 0.3);
  }
}

TEST(ScriptedOperator, TheNextDirectionTurnsNothing) {
  Phase screw = lever_phase(0.5, {0, 0, 1}, 1.0);
  screw.screw.emplace();
  ScriptedOperator the_operator({screw, lever_phase(0.5, {1, 0, 0}, 1.0)});
  for (int tick = 0; tick < 200; ++tick) {
    EXPECT_EQ(the_operator.step(Mat3::Identity(), 0.0025).hand.turning_W, Vec3(0, 0, 10));
  }
  const HandInput& hand = the_operator.step(Mat3::Identity(), 0.0025).hand;
  EXPECT_EQ(hand.turning_W, Vec3::Zero());
  EXPECT_EQ(hand.direction_W, Vec3::UnitX());
}

TEST(ScriptedOperator, ASecondHandMovesMeanwhileInTheSameFrame) {
  const Mat3 R_WT = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();  // x to y
  Phase with_ball = ball_phase(0.0025, {0.1, 0, 0}, PhaseFrame::tool);
  with_ball.second.linear = Vec3(0.2, 0, 0);
  Phase with_lever = lever_phase(0.0025, {1, 0, 0}, 1.0);
  with_lever.second.angular = Vec3(0, 0, 0.3);
  Phase faulty = ball_phase(0.0025, {0.1, 0, 0});
  faulty.second.linear.x() = nan;
  ScriptedOperator the_operator({with_ball, with_lever, faulty});
  EXPECT_NEAR(the_operator.step(R_WT, 0.0025).second.ball.linear.y(), 0.2, 1e-15);
  EXPECT_EQ(the_operator.step(R_WT, 0.0025).second.ball.angular, Vec3(0, 0, 0.3));
  EXPECT_FALSE(the_operator.step(R_WT, 0.0025).sound);
  const Command& over = the_operator.step(R_WT, 0.0025);
  EXPECT_TRUE(over.sound);
  EXPECT_EQ(over.second.ball.linear, Vec3::Zero());
}

TEST(ScriptedOperator, ASecondHandMovesALeverOfItsOwn) {
  const Mat3 R_WT = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();  // x to y
  Phase both = lever_phase(0.005, {0, 0, 1}, 1.0);
  both.frame = PhaseFrame::tool;
  both.second_lever = {Vec3::UnitX(), -2.0};
  Phase faulty = both;
  faulty.second_lever->rate = nan;
  ScriptedOperator the_operator({both, ball_phase(0.0025, {0.1, 0, 0}), faulty});
  const Command& begun = the_operator.step(R_WT, 0.0025);
  EXPECT_EQ(begun.hand.lever_rate, 1.0);
  EXPECT_EQ(begun.second.lever_rate, -2.0);
  EXPECT_NEAR(begun.second.direction_W.y(), 1.0, 1e-15);
  // The direction stays where it was at the beginning of the phase.
  EXPECT_NEAR(the_operator.step(Mat3::Identity(), 0.0025).second.direction_W.y(), 1.0, 1e-15);
  EXPECT_EQ(the_operator.step(R_WT, 0.0025).second.lever_rate, 0.0);
  EXPECT_FALSE(the_operator.step(R_WT, 0.0025).sound);
}

TEST(ScriptedOperator, HandThatDoesNotLeadTheLeverHoldsItStill) {
  ScriptedOperator the_operator({lever_phase(0.5, {0, 1, 0}, 2.0), ball_phase(0.5, {0.1, 0, 0})});
  for (int tick = 0; tick < 200; ++tick) {
    const HandInput& hand = the_operator.step(Mat3::Identity(), 0.0025).hand;
    ASSERT_EQ(hand.lever_rate, 2.0);
    ASSERT_EQ(hand.direction_W, Vec3::UnitY());
    ASSERT_EQ(hand.ball.linear, Vec3::Zero());
  }
  const HandInput& hand = the_operator.step(Mat3::Identity(), 0.0025).hand;
  EXPECT_EQ(hand.lever_rate, 0.0);
  EXPECT_EQ(hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(hand.ball.linear, Vec3(0.1, 0, 0));
}

TEST(ScriptedOperator, AScaleHoldsUntilTheNext) {
  ScriptedOperator hands({{.duration = 0.01},
                          {.duration = 0.01, .scale = 0.5},
                          {.duration = 0.01},
                          {.duration = 0.01, .scale = 2.0}});
  std::vector<double> scales;
  for (int tick = 0; tick < 5; ++tick) {
    scales.push_back(hands.step(Mat3::Identity(), 0.01).hand.scale);
  }
  EXPECT_EQ(scales, (std::vector<double>{1.0, 0.5, 0.5, 2.0, 2.0}));
}

TEST(ScriptedOperator, FixturesAndComplianceStayAsAPhaseSetThem) {
  ScriptedOperator hands({{.duration = 0.01},
                          {.duration = 0.01, .guides = 5, .guide_strength = 0.5},
                          {.duration = 0.01, .compliant = 3},
                          {.duration = 0.01, .guides = -1}});
  std::vector<int> guides, compliant;
  std::vector<double> strengths;
  for (int tick = 0; tick < 5; ++tick) {
    const HandInput& hand = hands.step(Mat3::Identity(), 0.01).hand;
    guides.push_back(hand.guides);
    compliant.push_back(hand.compliant);
    strengths.push_back(hand.guide_strength);
  }
  EXPECT_EQ(guides, (std::vector<int>{-1, 5, 5, -1, -1}));
  EXPECT_EQ(compliant, (std::vector<int>{-1, -1, 3, 3, 3}));
  EXPECT_EQ(strengths, (std::vector<double>{1.0, 0.5, 0.5, 0.5, 0.5}));
}

TEST(ScriptedOperator, SilentDeviceKeepsItsLastSampleAndSaysItsAge) {
  Phase lost;
  lost.duration = 0.1;
  lost.silent = true;
  ScriptedOperator the_operator({ball_phase(0.1, {0.1, 0, 0}), lost, ball_phase(0.1, {0, 0, 0})});
  for (int tick = 0; tick < 40; ++tick) {
    ASSERT_EQ(the_operator.step(Mat3::Identity(), 0.0025).silent_for, 0.0);
  }
  for (int tick = 1; tick <= 40; ++tick) {
    const Command& command = the_operator.step(Mat3::Identity(), 0.0025);
    ASSERT_NEAR(command.silent_for, 0.0025 * tick, 1e-12);
    ASSERT_TRUE(command.sound);
    ASSERT_EQ(command.hand.ball.linear, Vec3(0.1, 0, 0));
  }
  EXPECT_EQ(the_operator.step(Mat3::Identity(), 0.0025).silent_for, 0.0);
}

}  // namespace operator_test
}  // namespace repel::network
