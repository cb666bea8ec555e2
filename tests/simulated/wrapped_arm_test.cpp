// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/wrapped_arm.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace repel {
namespace wrapped_arm_test {

/// Says what it was asked to do.
class TellingArm final : public TorqueDrivenArm {
 public:
  explicit TellingArm(std::string& told) : told_(told) {}
  void set_torques(std::span<const double> torques) noexcept override {
    told_ += "torques " + std::to_string(torques.size()) + ' ';
  }
  void step(double period) noexcept override { told_ += period == 0.5 ? "step " : "?"; }
  void read_positions(std::span<double> out) const noexcept override { out[0] = 1.0; }
  void read_velocities(std::span<double> out) const noexcept override { out[0] = 2.0; }
  void enable() noexcept override { told_ += "enable "; }
  void stop() noexcept override { told_ += "stop "; }
  void engage_brakes(bool on) noexcept override { told_ += on ? "on " : "off "; }
  [[nodiscard]] ArmState state() const noexcept override { return ArmState::stopped; }
  [[nodiscard]] ContactReport contact() const noexcept override {
    return {.steps = 1, .deepest = 3.0};
  }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return Wrench{{4, 0, 0}, {0, 0, 0}};
  }

 private:
  std::string& told_;
};

TEST(WrappedArm, IsTheArmInside) {
  std::string told;
  WrappedArm arm(std::make_unique<TellingArm>(told));
  const double torques[] = {1.0, 2.0};
  double q = 0.0, v = 0.0;
  arm.set_torques(torques);
  arm.step(0.5);
  arm.enable();
  arm.stop();
  arm.engage_brakes(true);
  arm.engage_brakes(false);
  arm.read_positions({&q, 1});
  arm.read_velocities({&v, 1});
  EXPECT_EQ(told, "torques 2 step enable stop on off ");
  EXPECT_EQ(q, 1.0);
  EXPECT_EQ(v, 2.0);
  EXPECT_EQ(arm.state(), ArmState::stopped);
  EXPECT_EQ(arm.contact().deepest, 3.0);
  EXPECT_EQ(arm.read_wrench()->force.x(), 4.0);
}

}  // namespace wrapped_arm_test
}  // namespace repel
