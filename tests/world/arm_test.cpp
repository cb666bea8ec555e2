// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/arm.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace arm_test {

/// An arm with only the required functions.
struct Arm final : TorqueDrivenArm {
  void set_torques(std::span<const double> /*torques*/) noexcept override {}
  void step(double /*period*/) noexcept override {}
  void read_positions(std::span<double> /*out*/) const noexcept override {}
  void read_velocities(std::span<double> /*out*/) const noexcept override {}
};

TEST(ArmModel, IsEmptyAndAtTheOriginUnlessSaidOtherwise) {
  const ArmModel model;
  EXPECT_TRUE(model.links.empty());
  EXPECT_TRUE(model.X_WB.isApprox(Pose::Identity()));
  EXPECT_TRUE(model.X_LT.isApprox(Pose::Identity()));
  EXPECT_EQ(model.gravity_W, Vec3(0, 0, -9.81));
}

TEST(TorqueDrivenArm, IsEnabledAndTouchesNothingUnlessItSaysOtherwise) {
  Arm arm;
  arm.stop();
  arm.engage_brakes(true);
  EXPECT_EQ(arm.state(), ArmState::enabled) << "an arm without a drive that stops";
  EXPECT_EQ(arm.contact().steps, 0);
}

}  // namespace arm_test
}  // namespace repel
