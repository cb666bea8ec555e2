// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/sensed_arm.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace repel {
namespace sensed_arm_test {

/// An arm whose sensor reads a constant, or nothing.
struct Steady : TorqueDrivenArm {
  explicit Steady(const std::optional<Wrench>& always) : reading(always) {}
  void set_torques(std::span<const double> /*torques*/) noexcept override {}
  void step(double /*period*/) noexcept override {}
  void read_positions(std::span<double> out) const noexcept override { out[0] = 7.0; }
  void read_velocities(std::span<double> out) const noexcept override { out[0] = 8.0; }
  [[nodiscard]] ArmState state() const noexcept override { return ArmState::stopped; }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override { return reading; }
  std::optional<Wrench> reading;
};

SensedArm with(const SensorErrors& errors,
               const std::optional<Wrench>& reading = Wrench{{1, 2, 3}, {4, 5, 6}}) {
  return {std::make_unique<Steady>(reading), errors};
}

TEST(SensedArm, AddsBiasAndNoiseWithinTheirBounds) {
  const SensorErrors errors{
      .force_noise = 0.5, .torque_noise = 0.1, .bias = {{10, 0, 0}, {0, 0, 20}}, .seed = 3};
  SensedArm arm = with(errors), same = with(errors);
  double mean = 0.0, most = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Wrench F = *arm.read_wrench();
    EXPECT_EQ(F.force, same.read_wrench()->force) << "the same seed";
    EXPECT_LE(std::abs(F.force.x() - 11.0), 0.5);
    EXPECT_LE(std::abs(F.torque.z() - 26.0), 0.1);
    most = std::max(most, std::abs(F.force.x() - 11.0));
    mean += (F.force.y() - 2.0) / 4000.0;
    arm.step(0.001);
    same.step(0.001);
  }
  EXPECT_GT(most, 0.49);
  EXPECT_NEAR(mean, 0.0, 0.02);
}

TEST(SensedArm, ReadsTheSameUntilTheNextStepAndNothingWithoutASensor) {
  SensedArm arm = with({.force_noise = 1.0});
  const Wrench first = *arm.read_wrench();
  EXPECT_EQ(first.force, arm.read_wrench()->force);
  arm.step(0.001);
  EXPECT_NE(first.force, arm.read_wrench()->force);
  EXPECT_FALSE(with({.force_noise = 1.0}, {}).read_wrench());
}

TEST(SensedArm, EverythingElseIsThatOfTheArm) {
  SensedArm arm = with({});
  std::array<double, 1> out{};
  arm.read_positions(out);
  EXPECT_EQ(out[0], 7.0);
  arm.read_velocities(out);
  EXPECT_EQ(out[0], 8.0);
  EXPECT_EQ(arm.state(), ArmState::stopped);
}

TEST(SensedArm, ErrorsOutOfRangeAreRefused) {
  EXPECT_TRUE(SensorErrors{}.none());
  EXPECT_FALSE(SensorErrors{.torque_noise = 0.1}.none());
  EXPECT_THROW(with({.force_noise = -1.0}), SetupError);
  EXPECT_THROW(with({.torque_noise = std::nan("")}), SetupError);
  EXPECT_THROW(with({.bias = {{std::nan(""), 0, 0}, {0, 0, 0}}}), SetupError);
}

}  // namespace sensed_arm_test
}  // namespace repel
