// SPDX-License-Identifier: BSD-3-Clause
// The adapter to an arm that takes joint positions, with a stand-in for robot and library.
#include "position_servo/position_servo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "position_servo/ur_arm.hpp"

namespace repel::test {
namespace position_servo_test {

using ur_rtde::RTDEControlInterface, ur_rtde::RTDEReceiveInterface;

// What the adapter takes for the interface of ur_rtde, as its headers have it.
static_assert(std::constructible_from<RTDEControlInterface, std::string, double> &&
              std::constructible_from<RTDEReceiveInterface, std::string, double>);
static_assert(requires(RTDEControlInterface & control, RTDEReceiveInterface& receive,
                       const std::vector<double>& q) {
  { control.servoJ(q, 0.0, 0.0, 0.002, 0.03, 300.0) } -> std::same_as<bool>;
  { control.servoStop() } -> std::same_as<bool>;
  { control.initPeriod() } -> std::same_as<std::chrono::steady_clock::time_point>;
  control.waitPeriod(std::chrono::steady_clock::time_point());
  { receive.getActualQ() } -> std::same_as<std::vector<double>>;
  { receive.getActualQd() } -> std::same_as<std::vector<double>>;
  { receive.getTimestamp() } -> std::same_as<double>;
  { receive.isProtectiveStopped() } -> std::same_as<bool>;
  { receive.isEmergencyStopped() } -> std::same_as<bool>;
});

constexpr double rate = 500.0;   // [Hz]
constexpr double face = -0.6;    // [m] of the wall, along x
constexpr double radius = 0.05;  // [m] of the ball at the tool

/// A robot whose hand is led towards the wall by 0.1 m/s.
class PositionServo : public testing::Test {
 protected:
  CellDescription description() {
    CellDescription cell;
    cell.rate_hz = rate;
    cell.arms.push_back(adapters::ur5e(receive.getActualQ()));
    cell.arms[0].parts.push_back({"ball", Shape::sphere(radius)});
    const Pose X_WP(Eigen::Translation3d(face - 0.1, -0.13, 0.5));
    cell.obstacles.push_back({"wall", Shape::box({0.1, 0.5, 0.5}), X_WP});
    return cell;
  }
  /// One motion of `seconds`. @param each after every period of it
  void drive(double seconds, const std::function<void(adapters::PositionServo&)>& each = {}) {
    adapters::PositionServo servo(
        description(),
        {.inertia = {2.0, 2.0, 1.0, 0.2, 0.2, 0.2}, .acceleration = 10.0, .response = told});
    const ArmDescription truth = adapters::ur5e(receive.getActualQ());
    network::HandInput hand;
    hand.ball.linear = {-0.1, 0.0, 0.0};
    const auto after = [&](adapters::PositionServo& own) {
      tick = *own.record();
      if (tick.time < silent_from) own.lead(hand);
      if (tick.time > seconds) own.finish();
      truth.kinematics->update(robot.q);
      gap = truth.kinematics->X_WT().translation().x() - radius - face;
      least_gap = std::min(least_gap, gap);
      if (each) each(own);
    };
    adapters::run(control, receive, servo, 1.0 / rate, gains, after);
  }

  // A robot of its own for each test.
  std::string address = testing::UnitTest::GetInstance()->current_test_info()->name();
  RTDEControlInterface control{address, rate};
  RTDEReceiveInterface receive{address, rate};
  ur_rtde::stand_in::SimulatedUr& robot = ur_rtde::stand_in::robot_at(address);
  adapters::ServoGains gains;
  double told = 0.04;  // [s] response
  double silent_from = 1e9;
  double gap = 0.0;  // [m] between ball and wall, in truth
  double least_gap = 1.0;
  TickRecord tick;
};

TEST_F(PositionServo, ToolPressesOnTheWallAndStaysOutOfIt) {
  double late_force = 0.0, late_speed = 0.0;
  drive(5.0, [&](const adapters::PositionServo&) {
    if (tick.time < 4.5 || tick.time > 5.0) return;
    late_force = tick.virtual_force.force.norm();
    for (const double v : robot.v) late_speed = std::max(late_speed, std::abs(v));
  });
  EXPECT_GT(least_gap, 0.0);
  EXPECT_GT(late_force, 20.0);
  EXPECT_LT(late_speed, 5e-3);
  EXPECT_FALSE(robot.is_servoing);
}

TEST_F(PositionServo, ASmootherArmNeedsALongerResponse) {
  gains.lookahead_time = 0.1;
  told = 0.11;
  drive(5.0);
  EXPECT_GT(least_gap, 0.0);
  EXPECT_LT(least_gap, 0.03);
}

TEST_F(PositionServo, ProtectiveStopEndsItAndANewOneGoesOn) {
  const auto stop = [&](const adapters::PositionServo&) { robot.is_stopped = tick.time > 0.5; };
  EXPECT_THROW(drive(5.0, stop), adapters::ArmStopped);
  EXPECT_FALSE(robot.is_servoing);
  EXPECT_GT(gap, 0.0);
  robot.is_stopped = false;
  drive(5.0);
  EXPECT_GT(least_gap, 0.0);
  EXPECT_LT(gap, 0.03);
}

TEST_F(PositionServo, ABlockedArmThatIsFreeAgainStaysOutOfTheWall) {
  drive(3.0, [&](const adapters::PositionServo&) {
    robot.is_blocked = tick.time > 0.3 && tick.time < 1.0;
  });
  EXPECT_LT(robot.fastest, 2.0);  // [rad/s] it is sent little ahead meanwhile
  EXPECT_GT(least_gap, 0.0);
}

TEST_F(PositionServo, SilentMasterLetsGoAndTheWallStays) {
  silent_from = 3.0;
  drive(4.0, [&](const adapters::PositionServo&) {
    if (tick.time > 3.1) {
      EXPECT_NE(tick.status & status::silent_device, 0U);
    }
  });
  EXPECT_GT(least_gap, 0.0);
}

TEST(UrArm, FlangeIsWhereTheMakerHasIt) {
  const ArmDescription arm = adapters::ur5e(std::vector<double>(6));
  arm.kinematics->update(arm.start);
  const Vec3 flange = arm.kinematics->X_WT().translation();
  EXPECT_LT((flange - Vec3(-0.8172, -0.2329, 0.0628)).norm(), 1e-9);
}

}  // namespace position_servo_test
}  // namespace repel::test
