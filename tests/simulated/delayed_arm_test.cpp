// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/delayed_arm.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace repel {
namespace delayed_arm_test {

/// Remembers the torques it was given.
struct Listener : TorqueDrivenArm {
  explicit Listener(std::vector<double>& into) : heard(&into) {}
  void set_torques(std::span<const double> torques) noexcept override {
    heard->insert(heard->end(), torques.begin(), torques.end());
  }
  void step(double period) noexcept override { heard->push_back(-period); }
  void read_positions(std::span<double> out) const noexcept override { out[0] = 7.0; }
  void read_velocities(std::span<double> out) const noexcept override { out[0] = 8.0; }
  [[nodiscard]] ArmState state() const noexcept override { return ArmState::stopped; }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return Wrench{{1, 2, 3}, {4, 5, 6}};
  }
  std::vector<double>* heard;
};

std::vector<double> heard_with(int delay) {
  std::vector<double> heard;
  DelayedArm arm(std::make_unique<Listener>(heard), 2, delay);
  for (const double torque : {1.0, 2.0, 3.0, 4.0}) {
    arm.set_torques(std::array{torque, 10.0 * torque});
  }
  return heard;
}

TEST(DelayedArm, TorquesArriveInTheirOrderSoManyCallsLater) {
  EXPECT_EQ(heard_with(0), (std::vector<double>{1, 10, 2, 20, 3, 30, 4, 40}));
  EXPECT_EQ(heard_with(1), (std::vector<double>{0, 0, 1, 10, 2, 20, 3, 30}));
  EXPECT_EQ(heard_with(3), (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 10}));
}

TEST(DelayedArm, EverythingElseIsThatOfTheArm) {
  std::vector<double> heard;
  DelayedArm arm(std::make_unique<Listener>(heard), 2, 1);
  arm.step(0.5);
  EXPECT_EQ(heard, std::vector<double>{-0.5});
  std::array<double, 2> out{};
  arm.read_positions(out);
  EXPECT_EQ(out[0], 7.0);
  arm.read_velocities(out);
  EXPECT_EQ(out[0], 8.0);
  EXPECT_EQ(arm.state(), ArmState::stopped);
  ASSERT_TRUE(arm.read_wrench());
  EXPECT_EQ(arm.read_wrench()->torque, Vec3(4, 5, 6));
}

TEST(DelayedArm, DelayOutOfRangeIsRefused) {
  std::vector<double> heard;
  EXPECT_THROW(DelayedArm(std::make_unique<Listener>(heard), 2, -1), SetupError);
  EXPECT_THROW(DelayedArm(std::make_unique<Listener>(heard), 2, 101), SetupError);
}

}  // namespace delayed_arm_test
}  // namespace repel
