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
