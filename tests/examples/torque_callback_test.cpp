// SPDX-License-Identifier: BSD-3-Clause
// The adapter to a torque callback, with a stand-in for robot and library.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include <franka/exception.h>

#include "examples/heap.hpp"
#include "torque_callback/torque_callback.hpp"

namespace repel::test {
namespace torque_callback_test {

constexpr double face = 0.45;    // [m] of the wall, along x
constexpr double radius = 0.05;  // [m] of the ball at the tool
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

CellDescription wall_in_front() {
  CellDescription cell;
  cell.arms.emplace_back().parts.push_back({"ball", Shape::sphere(radius)});
  const Pose X_WP(Eigen::Translation3d(face + 0.1, 0.0, 0.5));
  cell.obstacles.push_back({"wall", Shape::box({0.1, 0.5, 0.5}), X_WP});
  return cell;
}

/// A robot whose hand is led towards the wall by 0.1 m/s.
class TorqueCallback : public testing::Test {
 protected:
  /// One motion of `seconds`, with a new callback. @param each before every call of it
  void drive(double seconds, const std::function<void(const franka::RobotState&)>& each = {}) {
    callback = std::make_unique<adapters::TorqueCallback>(model, robot.readOnce(), wall_in_front());
    network::HandInput hand;
    hand.ball.linear = {0.1, 0.0, 0.0};
    double time = 0.0;
    const auto control = [&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      if (each) each(state);
      if (time < silent_from) callback->lead(hand);
      if (time > seconds) callback->finish();
      gap = face - radius - model.pose(franka::Frame::kEndEffector, state)[12];
      least_gap = std::min(least_gap, gap);
      const HeapScope counted;
      return (*callback)(state, period);
    };
    robot.control(control, limit_rate, franka::kMaxCutoffFrequency);
  }
  const TickRecord& tick() const { return *callback->record(); }
  double fastest_joint() {
    double fastest = 0.0;
    for (const double v : robot.readOnce().dq) fastest = std::max(fastest, std::abs(v));
    return fastest;
  }

  franka::Robot robot{"stand-in"};
  franka::Model model = robot.loadModel();
  std::unique_ptr<adapters::TorqueCallback> callback;
  bool limit_rate = true;
  double silent_from = 1e9;  // [s] the master reports nothing from here on
  double gap = 0.0;          // [m] between ball and wall, in truth
  double least_gap = 1.0;
};

TEST_F(TorqueCallback, ToolPressesOnTheWallAndStaysOutOfIt) {
  limit_rate = false;  // the robot gives up at 1000 N m/s
  const std::int64_t before = heap_calls();
  drive(4.0, [&, step = 0](const franka::RobotState&) mutable {
    if (++step == 4000) {
      EXPECT_NEAR(tick().virtual_force.force.norm(), 72.0, 5.0);
    }
  });
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(least_gap, 6e-3);
  EXPECT_EQ(heap_calls(), before);
  EXPECT_LT(robot.fastest_change(), 1000.0);
  EXPECT_GT(robot.fastest_change(), 0.0);
}

TEST_F(TorqueCallback, LateCallbacksAreNoFault) {
  int late = 0;
  Status found = 0;
  drive(4.0, [&, step = 0](const franka::RobotState&) mutable {
    if (callback->record() != nullptr) {
      late += tick().elapsed > 1 ? 1 : 0;
      found |= tick().status;
    }
    if (++step % 50 == 0) robot.lose(step / 50 % 10);
  });
  EXPECT_GT(late, 50);
  EXPECT_EQ(found & status::failsafe & ~status::bad_command, 0U) << to_text(found);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(least_gap, 6e-3);
}

TEST_F(TorqueCallback, AfterACommunicationErrorANewOneGoesOn) {
  const auto lose_all = [&, step = 0](const franka::RobotState&) mutable {
    if (++step == 900) robot.lose(30);
  };
  EXPECT_THROW(drive(4.0, lose_all), franka::ControlException);
  EXPECT_GT(gap, 0.0);
  EXPECT_THROW(drive(4.0), franka::ControlException);  // not recovered yet
  robot.automaticErrorRecovery();
  drive(4.0);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap, 20e-3);
}

TEST_F(TorqueCallback, LostReadingsStopTheArm) {
  int steps = 0;
  const auto count = [&](const franka::RobotState&) { ++steps; };
  robot.distort = [&](franka::RobotState& state) {
    if (steps >= 800) state.q[3] = nan;
  };
  try {
    drive(4.0, count);
    FAIL() << "the brakes were not requested";
  } catch (const adapters::Stopped& e) {
    EXPECT_NE(std::string(e.what()).find("bad_joints"), std::string::npos) << e.what();
  }
  EXPECT_GT(steps, 810);
  EXPECT_LT(steps, 830);  // 20 ms of braking by prediction come first
  EXPECT_EQ(robot.readOnce().robot_mode, franka::RobotMode::kIdle);
  robot.distort = nullptr;
  drive(4.0);
  EXPECT_GT(least_gap, 1e-3);
}

TEST_F(TorqueCallback, SilentMasterLetsGoAndTheWallStays) {
  silent_from = 3.0;
  drive(4.0, [&, step = 0](const franka::RobotState&) mutable {
    if (++step == 3030) {
      EXPECT_NE(tick().status & status::silent_device, 0U);
    }
    if (step == 3500) {
      EXPECT_EQ(tick().stop, Stop::holding);
    }
  });
  EXPECT_GT(gap, 3e-3);  // pushed out by the wall, by nobody held against it
}

TEST_F(TorqueCallback, FinishingInMotionEndsAtRest) {
  const double begin = robot.readOnce().time.toSec();
  double at_end = 0.0;
  drive(0.8, [&, step = 0](const franka::RobotState&) mutable {
    if (++step == 800) at_end = tick().v_WT.x();
  });
  EXPECT_GT(at_end, 0.05);  // [m/s]
  EXPECT_LT(robot.readOnce().time.toSec() - begin, 1.5);
  EXPECT_LT(fastest_joint(), 0.01);
  EXPECT_GT(gap, 10e-3);
}

TEST_F(TorqueCallback, RobotThatDoesNotMoveIsAStoppedDrive) {
  franka::RobotState state = robot.readOnce();
  adapters::TorqueCallback idle(model, state, wall_in_front());
  state.robot_mode = franka::RobotMode::kUserStopped;
  idle(state, franka::Duration(0));
  EXPECT_NE(idle.record()->status & status::arm_stopped, 0U);
}

TEST(FrankaKinematics, JacobianOfAPointOnALinkIsItsDerivative) {
  franka::Robot robot("stand-in");
  const franka::Model model = robot.loadModel();
  const franka::RobotState state = robot.readOnce();
  adapters::FrankaKinematics arm(model, state);
  const Vec3 p_LQ(0.1, -0.2, 0.05);
  for (int link = 0; link < 7; ++link) {
    arm.update(state.q);
    const Vec3 p_WQ = arm.X_WL(link) * p_LQ;
    Jacobian J(6, 7);
    arm.jacobian(link, p_WQ, J);
    for (int i = 0; i < 7; ++i) {
      std::array<double, 7> q = state.q;
      constexpr double step = 1e-6;  // [rad]
      q[static_cast<std::size_t>(i)] += step;
      arm.update(q);
      const Vec3 rate = (arm.X_WL(link) * p_LQ - p_WQ) / step;
      EXPECT_LT((J.col(i).head<3>() - rate).norm(), 1e-5) << "link " << link << ", joint " << i;
    }
  }
}

TEST(FrankaLimits, OfAnotherArmAreKept) {
  franka::Robot robot("stand-in");
  const franka::Model model = robot.loadModel();
  CellDescription cell = wall_in_front();
  cell.arms[0].model = adapters::franka_model(adapters::fr3_rectangular);
  franka::RobotState state = robot.readOnce();
  EXPECT_NO_THROW(adapters::TorqueCallback(model, state, wall_in_front()));
  state.q[1] = 1.6;  // within the range of the first arm alone
  EXPECT_THROW(adapters::TorqueCallback(model, state, std::move(cell)), SetupError);
}

TEST(FrankaLimits, SuggestedRangeLiesWithinThatOfTheArm) {
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_GT(adapters::fr3_rectangular.lower[i], adapters::fr3.lower[i]);
    EXPECT_LT(adapters::fr3_rectangular.upper[i], adapters::fr3.upper[i]);
    EXPECT_LT(adapters::fr3_rectangular.rate[i], adapters::fr3.rate[i]);
  }
}

TEST(FrankaKinematics, LinksMayHaveParts) {
  franka::Robot robot("stand-in");
  const franka::Model model = robot.loadModel();
  CellDescription cell = wall_in_front();
  cell.arms[0].parts.push_back({"elbow", Shape::sphere(0.1), Pose::Identity(), 3});
  EXPECT_NO_THROW(adapters::TorqueCallback(model, robot.readOnce(), std::move(cell)));
}

}  // namespace torque_callback_test
}  // namespace repel::test
