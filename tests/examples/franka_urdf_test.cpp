// SPDX-License-Identifier: BSD-3-Clause
// The arm of the maker's URDF beside the model library.
#include "torque_callback/franka_urdf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include <franka/model.h>

#include "examples/heap.hpp"
#include "torque_callback/torque_callback.hpp"

namespace repel::test {
namespace franka_urdf_test {

/// A robot with a tool and a load, and what its URDF says of it.
class FrankaUrdf : public testing::Test {
 protected:
  void SetUp() override {
    robot.setEE({0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.02, 0.0, 0.15, 1});
    robot.setLoad(1.2, {0.03, -0.02, 0.08}, {4e-3, 1e-4, 0, 1e-4, 5e-3, 0, 0, 0, 6e-3});
  }
  ArmDescription arm() {
    const Robot read = parse_arm(adapters::urdf_of(robot, ""), {.tip = "link8"});
    return adapters::arm_of(read, robot.readOnce());
  }

  franka::Robot robot{"stand-in"};
  franka::Model model = robot.loadModel();
};

TEST_F(FrankaUrdf, ArmOfTheUrdfIsThatOfTheModelLibrary) {
  const ArmDescription described = arm();
  ArmKinematics& kinematics = *described.kinematics;
  franka::RobotState state = robot.readOnce();
  adapters::FrankaKinematics library(model, state);
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(-2.5, 2.5);
  for (int pose = 0; pose < 100; ++pose) {
    for (double& q : state.q) q = angle(random);
    kinematics.update(state.q);
    library.update(state.q);
    EXPECT_TRUE(kinematics.X_WT().isApprox(library.X_WT(), 1e-12));
    Jacobian J(6, 7), expected(6, 7);
    kinematics.tool_jacobian(J);
    library.tool_jacobian(expected);
    EXPECT_LT((J - expected).norm(), 1e-12);
    EXPECT_TRUE(kinematics.X_WL(3).isApprox(library.X_WL(3), 1e-12));
    Eigen::MatrixXd M(7, 7), expected_M(7, 7);
    ASSERT_TRUE(kinematics.mass_matrix(M) && library.mass_matrix(expected_M));
    EXPECT_LT((M - expected_M).norm(), 1e-10);
    std::array<double, 7> weight{};
    kinematics.gravity_torques(weight);
    EXPECT_EQ(weight, (std::array<double, 7>{}));
  }
}

TEST_F(FrankaUrdf, MakersTableAndItsUrdfAgree) {
  const Robot read = load_arm("bench/arms/panda.urdf", {.tip = "panda_link8"});
  const ArmDescription described = adapters::arm_of(read, robot.readOnce(), {.has_hand = true});
  franka::RobotState state = robot.readOnce();
  described.kinematics->update(state.q);
  adapters::FrankaKinematics library(model, state);
  EXPECT_TRUE(described.kinematics->X_WT().isApprox(library.X_WT(), 1e-9));
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_DOUBLE_EQ(read.arm.links[i].lower, adapters::fer.lower[i]);
    EXPECT_DOUBLE_EQ(read.arm.links[i].upper, adapters::fer.upper[i]);
    EXPECT_DOUBLE_EQ(read.arm.links[i].velocity_limit, adapters::fer.rate[i]);
    EXPECT_DOUBLE_EQ(read.arm.links[i].effort_limit, adapters::fer.torque[i]);
  }
  EXPECT_GT(described.parts.size(), 7U);
  EXPECT_DOUBLE_EQ(described.model.links[6].mass, read.arm.links[6].mass + 1.2);
}

TEST_F(FrankaUrdf, ElbowStaysOutOfAWallThatOnlyItReaches) {
  CellDescription cell;
  cell.arms.push_back(arm());
  const std::array<double, 7> q = robot.readOnce().q;
  const auto elbow = [&](const franka::RobotState& state) {
    const std::array<double, 16> X = model.pose(franka::Frame::kJoint4, state);
    return Vec3(X[12], X[13], X[14]);
  };
  const Vec3 start = elbow(robot.readOnce());
  // Beside the elbow, 20 mm from its sphere.
  const Pose X_WP(Eigen::Translation3d(start.x(), start.y() + 0.08 + 0.05, start.z()));
  cell.obstacles.push_back({"wall", Shape::box({0.05, 0.05, 0.05}), X_WP});
  adapters::TorqueCallback callback(robot.readOnce(), std::move(cell));
  network::HandInput hand;
  hand.ball.linear = {0.0, 0.15, 0.0};
  double least = 1.0, way = 0.0, time = 0.0;
  const std::int64_t before = heap_calls();
  robot.control(
      [&](const franka::RobotState& state, franka::Duration period) {
        time += period.toSec();
        callback.lead(hand);
        if (time > 2.0) callback.finish();
        const HeapScope counted;
        const franka::Torques torques = callback(state, period);
        least = std::min(least, callback.record()->pairs.nearest);
        way = std::max(way, std::abs(state.q[0] - q[0]));
        return torques;
      },
      true, franka::kMaxCutoffFrequency);
  EXPECT_EQ(heap_calls(), before);
  EXPECT_GT(way, 0.01);
  EXPECT_GT(least, 1e-3);
  EXPECT_LT(least, 19e-3);
}

TEST(FrankaUrdfText, OfARobotThatCannotBeAskedIsThatOfTheFile) {
  struct Older {
  } robot;
  EXPECT_NE(adapters::urdf_of(robot, "bench/arms/panda.urdf").find("panda_link7"),
            std::string::npos);
  EXPECT_THROW((void)adapters::urdf_of(robot, "no/such.urdf"), SetupError);
}

}  // namespace franka_urdf_test
}  // namespace repel::test
