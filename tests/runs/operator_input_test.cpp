// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include <repel/runs/operator/operator_input.hpp>

namespace repel::runs {
namespace operator_input_test {

using network::Command;
constexpr double period = 0.0025;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

network::Script script() {
  network::Phase down;
  down.rates.linear = Vec3(0, 0, -0.1);
  network::Phase up;
  up.rates.linear = Vec3(0, 0, 0.1);
  return {down, up};
}

Mat3 quarter_turn() {
  return Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()).toRotationMatrix();
}

/// An operator whose controls somebody can take.
struct Bench {
  Controls controls;
  OperatorInput hands{script(), &controls};

  void post(const DriverInput& input) {
    controls.input.draft() = input;
    controls.input.post();
  }
  void push(const Vec3& rates) {
    DriverInput input;
    input.driver = Driver::page;
    input.rates.linear = rates;
    post(input);
  }
  const Command& tick(const Mat3& R_WT = Mat3::Identity()) { return hands.step(R_WT, period); }
  /// The command of the last of that many ticks.
  const Command& ticks(double seconds) {
    for (int i = 1; i < seconds / period; ++i) (void)tick();
    return tick();
  }
};

bool at_rest(const Command& command) {
  return command.hand.ball.linear.isZero(0.0) && command.hand.ball.angular.isZero(0.0) &&
         command.hand.lever_rate == 0.0;
}

TEST(OperatorInput, ObeyACommandWhileThereIsOne) {
  std::optional<Command> told;
  OperatorInput hands(script());
  hands.obey(told);
  OperatorInput plain(script());
  const Mat3 R_WT = Mat3::Identity();
  for (int i = 0; i < 100; ++i) {
    told.reset();
    EXPECT_EQ(hands.step(R_WT, period).hand.ball.linear, plain.step(R_WT, period).hand.ball.linear);
    told.emplace().hand.ball.linear = Vec3(0.01 * i, 0, 0);
    EXPECT_EQ(hands.step(R_WT, period).hand.ball.linear, Vec3(0.01 * i, 0, 0))
        << "the script waits";
  }
  hands.let_go();
  EXPECT_TRUE(at_rest(hands.step(R_WT, period)));
}

TEST(OperatorInput, PlayTheirScriptWhileNobodyTakesTheControls) {
  Bench bench;
  OperatorInput alone(script());
  network::ScriptedOperator plain(script());
  for (int i = 0; i < 1000; ++i) {
    const Command expected = plain.step(Mat3::Identity(), period);
    for (const Command& c : {bench.tick(), alone.step(Mat3::Identity(), period)}) {
      EXPECT_EQ(c.hand.ball.linear, expected.hand.ball.linear) << i;
      EXPECT_EQ(c.silent_for, 0.0);
    }
    EXPECT_EQ(bench.hands.phase(), plain.phase());
    EXPECT_EQ(alone.phase(), plain.phase());
  }
}

TEST(OperatorInput, OnceTakenTheScriptIsOver) {
  Bench bench;
  (void)bench.tick();
  bench.push(Vec3(0.1, 0, 0));
  EXPECT_EQ(bench.tick().hand.ball.linear, Vec3(0.1, 0, 0));
  EXPECT_EQ(bench.hands.phase(), script().size());
  DriverInput released;
  released.driver = Driver::nobody;
  bench.post(released);
  EXPECT_TRUE(at_rest(bench.tick()));
  EXPECT_TRUE(at_rest(bench.ticks(5.0)));
  EXPECT_EQ(bench.ticks(1.0).silent_for, 0.0);
  EXPECT_EQ(bench.hands.phase(), script().size());
}

TEST(OperatorInput, ADriverWhoSaysNothingIsAtRestAndThenSilent) {
  Bench bench;
  bench.push(Vec3(0.1, 0, 0));
  EXPECT_FALSE(at_rest(bench.ticks(OperatorInput::rest_after - period)));
  const Command& resting = bench.ticks(4 * period);
  EXPECT_TRUE(at_rest(resting));
  EXPECT_EQ(resting.silent_for, 0.0);
  EXPECT_EQ(bench.ticks(0.13).silent_for, 0.0);
  const Command& silent = bench.ticks(0.03);
  EXPECT_GT(silent.silent_for, OperatorInput::silent_after);
  EXPECT_TRUE(silent.sound);
  EXPECT_TRUE(at_rest(silent));
  const double before = silent.silent_for;
  EXPECT_GT(bench.ticks(1.0).silent_for, before);
  bench.push(Vec3(0, 0.1, 0));
  EXPECT_EQ(bench.tick().hand.ball.linear, Vec3(0, 0.1, 0));
  EXPECT_EQ(bench.tick().silent_for, 0.0);
}

TEST(OperatorInput, WhoSpeaksTenTimesASecondIsNeverSilent) {
  Bench bench;
  for (int i = 0; i < 50; ++i) {
    bench.push(Vec3(0.1, 0, 0));
    for (int k = 0; k < 40; ++k) {
      const Command& command = bench.tick();
      EXPECT_EQ(command.hand.ball.linear, Vec3(0.1, 0, 0));
      EXPECT_EQ(command.silent_for, 0.0);
    }
  }
}

TEST(OperatorInput, WhatIsNoNumberIsUnsoundAndAtRest) {
  for (const double bad : {nan, infinite, -infinite}) {
    for (int where = 0; where < 10; ++where) {
      Bench bench;
      bench.push(Vec3(0.1, 0, 0));
      EXPECT_TRUE(bench.tick().sound);
      DriverInput input;
      input.driver = Driver::page;
      input.in_tool = where % 2 == 0;
      input.lever_rate = 0.5;
      if (where < 3) input.rates.linear[where] = bad;
      if (where >= 3 && where < 6) input.rates.angular[where - 3] = bad;
      if (where >= 6 && where < 9) input.direction_W[where - 6] = bad;
      if (where == 9) input.lever_rate = bad;
      bench.post(input);
      const Command& command = bench.tick();
      EXPECT_FALSE(command.sound) << where;
      EXPECT_TRUE(at_rest(command)) << where;
      EXPECT_TRUE(command.hand.direction_W.allFinite()) << where;
      bench.push(Vec3(0, 0.1, 0));
      EXPECT_TRUE(bench.tick().sound) << where;
      EXPECT_EQ(bench.tick().hand.ball.linear, Vec3(0, 0.1, 0)) << where;
    }
  }
}

// Their axes rotate with the tool while no new command arrives.
TEST(OperatorInput, RatesInTheFrameOfTheToolTurnWithIt) {
  Bench bench;
  DriverInput input;
  input.driver = Driver::page;
  input.rates = {Vec3(0.1, 0, 0), Vec3(0, 0, 1)};
  input.in_tool = true;
  bench.post(input);
  EXPECT_TRUE(bench.tick().hand.ball.linear.isApprox(Vec3(0.1, 0, 0)));
  EXPECT_TRUE(bench.tick(quarter_turn()).hand.ball.linear.isApprox(Vec3(0, 0.1, 0)));
  EXPECT_TRUE(bench.tick(quarter_turn()).hand.ball.angular.isApprox(Vec3(0, 0, 1)));
  input.in_tool = false;
  bench.post(input);
  EXPECT_TRUE(bench.tick(quarter_turn()).hand.ball.linear.isApprox(Vec3(0.1, 0, 0)));
}

TEST(OperatorInput, TheLeverIsLedTheWayThatIsSaid) {
  Bench bench;
  DriverInput input;
  input.driver = Driver::page;
  input.lever_rate = 0.5;
  input.direction_W = Vec3::UnitY();
  bench.post(input);
  EXPECT_EQ(bench.tick().hand.lever_rate, 0.5);
  EXPECT_EQ(bench.tick().hand.direction_W, Vec3::UnitY());
  EXPECT_EQ(bench.ticks(0.2).hand.lever_rate, 0.0);
}

TEST(OperatorInput, ASecondHandIsLedBesideTheFirst) {
  Bench bench;
  DriverInput input;
  input.driver = Driver::page;
  input.rates.linear = Vec3(0, 0, 0.1);
  input.second = {Vec3(0.1, 0, 0), Vec3(0, 0, 1)};
  input.second_in_tool = true;
  bench.post(input);
  const Command led = bench.tick(quarter_turn());
  EXPECT_EQ(led.hand.ball.linear, Vec3(0, 0, 0.1));
  EXPECT_TRUE(led.second.ball.linear.isApprox(Vec3(0, 0.1, 0)));
  EXPECT_TRUE(bench.ticks(0.2).second.ball.linear.isZero(0.0)) << "whoever says nothing is at rest";
  input.second.linear.x() = nan;
  bench.post(input);
  const Command unsound = bench.tick();
  EXPECT_FALSE(unsound.sound);
  EXPECT_TRUE(unsound.second.ball.linear.isZero(0.0));
}

TEST(OperatorInput, WhatIsSwitchedStaysAndTheRestIsAsTheScriptLeftIt) {
  network::Script script = operator_input_test::script();
  script[0].scale = 2.0;
  script[0].guides = 5;
  script[0].compliant = 4;
  Controls controls;
  OperatorInput hands(script, &controls);
  (void)hands.step(Mat3::Identity(), period);
  const auto post = [&](const DriverInput& input) {
    controls.input.draft() = input;
    controls.input.post();
    return hands.step(Mat3::Identity(), period);
  };
  DriverInput input;
  input.driver = Driver::page;
  const Command taken = post(input);
  EXPECT_EQ(taken.hand.scale, 2.0);
  EXPECT_EQ(taken.hand.guides, 5);
  EXPECT_EQ(taken.hand.compliant, 4);
  input.scale = 0.5;
  input.guides = 0;
  input.guide_strength = 0.25;
  input.compliant = 65;
  const Command switched = post(input);
  EXPECT_EQ(switched.hand.scale, 0.5);
  EXPECT_EQ(switched.second.scale, 0.5);
  EXPECT_EQ(switched.hand.guides, 0);
  EXPECT_EQ(switched.hand.guide_strength, 0.25);
  EXPECT_EQ(switched.hand.compliant, 65);
  DriverInput released;
  released.driver = Driver::nobody;
  const Command later = post(released);
  EXPECT_EQ(later.hand.scale, 0.5);
  EXPECT_EQ(later.hand.guides, 0);
  EXPECT_EQ(later.hand.compliant, 65);
}

TEST(OperatorInput, FollowARecordingWhateverIsSaid) {
  Bench bench;
  TickRecord record;
  record.phase = 7;
  record.command.hand.ball.linear = Vec3(1, 2, 3);
  record.command.sound = false;
  record.command.silent_for = 0.5;
  bench.hands.follow(record);
  bench.push(Vec3(0.1, 0, 0));
  const Command& command = bench.tick();
  EXPECT_EQ(command.hand.ball.linear, Vec3(1, 2, 3));
  EXPECT_FALSE(command.sound);
  EXPECT_EQ(command.silent_for, 0.5);
  EXPECT_EQ(bench.hands.phase(), 7U);
}

#ifdef REPEL_RUNS_DEVICES
/// Includes the thread's end of a device.
struct FakeLink final : devices::DeviceLink {
  void post(const devices::Measured& measured) {
    measured_.draft() = measured;
    measured_.post();
  }
};

TEST(OperatorInput, ADeviceHasTheControlsFromTheBeginning) {
  Controls controls;
  FakeLink link;
  OperatorInput hands(script(), &controls, &link);
  EXPECT_EQ(hands.phase(), script().size());
  devices::Measured measured;
  measured.silent = false;
  measured.measured_cv = {Vec3(0.1, 0, 0), Vec3(0, 0, 1)};
  measured.lever_rate = 0.25;
  measured.lever_direction_W = Vec3::UnitZ();
  link.post(measured);
  controls.input.draft().driver = Driver::page;
  controls.input.post();
  const Command& command = hands.step(quarter_turn(), period);
  EXPECT_EQ(command.hand.ball.linear, Vec3(0.1, 0, 0));
  EXPECT_EQ(command.hand.ball.angular, Vec3(0, 0, 1));
  EXPECT_EQ(command.hand.lever_rate, 0.25);
  EXPECT_EQ(command.hand.direction_W, Vec3::UnitZ());
  EXPECT_EQ(command.silent_for, 0.0);
}

devices::Measured deflected(double x) {
  devices::Measured measured;
  measured.silent = false;
  measured.measured_cv.linear = Vec3(x, 0, 0);
  return measured;
}

// The network integrates what it gets: the sum is the pose of the hand, from where it took hold.
TEST(OperatorInput, AHandWhosePoseIsMeasuredIsFollowed) {
  FakeLink link;
  Controls controls;
  controls.over_device = true;
  OperatorInput hands(script(), &controls, &link);
  const auto tick = [&]() -> const Command& { return hands.step(Mat3::Identity(), period); };
  const auto drive = [&](Driver driver) {
    controls.input.draft() = {};
    controls.input.draft().driver = driver;
    controls.input.post();
  };
  devices::Measured measured = deflected(0.0);
  measured.operating_state = devices::OperatingState::enabled;
  measured.has_position = true;
  measured.position_W = Vec3(0.1, 0.2, 0.3);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 400; ++i) {
    if (i > 0) measured.position_W.z() -= 0.0001;
    link.post(measured);
    sum += period * tick().hand.ball.linear;
  }
  EXPECT_NEAR(sum.z(), -0.0399, 0.0005);
  EXPECT_NEAR(sum.x(), 0.0, 1e-12);
  // While a page drives, the hand moves without the tool.
  drive(Driver::page);
  link.post(measured);
  (void)tick();
  measured.position_W.z() += 0.04;
  drive(Driver::device);
  link.post(measured);
  EXPECT_TRUE(at_rest(tick()));
}

// Input of the device from the meantime is stale: it must not be applied when the device regains
// control.
TEST(OperatorInput, WhereAPageMayHaveThemFromADeviceItDrivesUntilItGivesThemBack) {
  FakeLink link;
  Controls controls;
  controls.over_device = true;
  OperatorInput hands(script(), &controls, &link);
  const auto tick = [&]() -> const Command& { return hands.step(Mat3::Identity(), period); };
  link.post(deflected(0.1));
  EXPECT_EQ(tick().hand.ball.linear, Vec3(0.1, 0, 0));
  controls.input.draft() = {};
  controls.input.draft().driver = Driver::page;
  controls.input.draft().rates.linear = Vec3(0, 0.2, 0);
  controls.input.post();
  EXPECT_EQ(tick().hand.ball.linear, Vec3(0, 0.2, 0));
  for (int i = 0; i < 200; ++i) (void)tick();
  EXPECT_GT(tick().silent_for, OperatorInput::silent_after) << "it is the page that is silent";
  controls.input.draft() = {};
  controls.input.draft().driver = Driver::device;
  controls.input.post();
  EXPECT_TRUE(at_rest(tick())) << "the thread of the device hangs";
  EXPECT_GE(tick().silent_for, OperatorInput::silent_after);
  link.post(deflected(0.3));
  EXPECT_EQ(tick().hand.ball.linear, Vec3(0.3, 0, 0));
  EXPECT_EQ(tick().silent_for, 0.0);
}

// It reports the fault itself, or its thread hangs.
TEST(OperatorInput, ADeviceThatIsSilentIsAtRest) {
  for (const bool hangs : {false, true}) {
    FakeLink link;
    OperatorInput hands(script(), nullptr, &link);
    devices::Measured measured;
    measured.silent = false;
    measured.measured_cv.linear = Vec3(0.1, 0, 0);
    link.post(measured);
    EXPECT_EQ(hands.step(Mat3::Identity(), period).silent_for, 0.0);
    const Command* command = nullptr;
    for (int i = 0; i < 200; ++i) {
      devices::Measured silent;
      silent.silent = true;
      if (!hangs) link.post(silent);
      command = &hands.step(Mat3::Identity(), period);
    }
    EXPECT_GE(command->silent_for, OperatorInput::silent_after);
    EXPECT_TRUE(at_rest(*command));
  }
}
#endif

// At the end of a run, for any operator: the fail-safe must see a silent device, and no lever may
// redirect the force stored in its spring.
TEST(OperatorInput, OnceLetGoTheyRestAndAreSilentWhoeverDrives) {
  network::Phase lever;
  lever.master = network::Master::torque_arm;
  lever.direction = Vec3(0, 0, -1);
  lever.lever_rate = 0.3;
  OperatorInput scripted({lever});
  EXPECT_EQ(scripted.step(Mat3::Identity(), period).hand.lever_rate, 0.3);
  scripted.let_go();
  for (int i = 0; i < 1000; ++i) {
    const Command& command = scripted.step(Mat3::Identity(), period);
    ASSERT_TRUE(at_rest(command)) << i;
    ASSERT_EQ(command.hand.direction_W, Vec3(0, 0, -1)) << i;
    ASSERT_GE(command.silent_for, OperatorInput::silent_after) << i;
    ASSERT_TRUE(command.sound) << i;
  }
  Bench bench;
  bench.push(Vec3(0.1, 0, 0));
  (void)bench.tick();
  bench.hands.let_go();
  bench.push(Vec3(nan, 0, 0));
  EXPECT_TRUE(at_rest(bench.tick()));
  EXPECT_TRUE(bench.tick().sound);
  EXPECT_GE(bench.tick().silent_for, OperatorInput::silent_after);
}

}  // namespace operator_input_test
}  // namespace repel::runs
