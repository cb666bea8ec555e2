// SPDX-License-Identifier: BSD-3-Clause
// The drive and the brakes of the Bullet arm.
#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/bullet/arm.hpp>

#include "simulated/brakes.hpp"

namespace repel::bullet {
namespace brake_test {

using namespace simulated;

auto maker(const ArmModel& model, const std::vector<double>& start) {
  return [=](double seconds) {
    Arm arm(model, {.watchdog = seconds});
    arm.reset(start);
    return arm;
  };
}

TEST(BulletBrakes, APumaStopsAndStandsAndGoesOn) {
  expect_a_sound_drive(maker(puma560(), puma_start()), puma_push());
}

TEST(BulletBrakes, AnArmOfWhoseMotorsNothingIsKnownDoesSoToo) {
  expect_a_sound_drive(maker(light_arm(), std::vector(6, 0.5)), light_push());
}

TEST(BulletBrakes, ALongChainStretchedOutDoesNotCreep) {
  expect_brakes_to_hold(maker(chain(), std::vector(8, 0.0)), std::vector(8, 0.0));
}

TEST(BulletBrakes, AStopForgetsWhatWasSent) {
  expect_a_stop_to_forget_what_was_sent(maker(turntable(0.5), {0.0}));
}

TEST(BulletBrakes, ABrakeSlowsByItsOwnTorqueAndLetsABiggerLoadSlip) {
  ArmModel model = pendulum();
  model.links[0].brake_torque = 3.0;
  model.links[0].coulomb_friction = 1.0;
  Arm arm(model, {.substeps = 1});
  arm.reset(std::vector{pi / 2}, std::vector{0.0});
  arm.engage_brakes(true);
  arm.step(1e-6);
  EXPECT_NEAR(velocities(arm)[0] / 1e-6, -(2.0 * 9.81 * 0.5 - 4.0) / 0.53, 1e-4);
}

TEST(BulletBrakes, SetUpNamesTheWatchdogThatIsOutOfRange) {
  EXPECT_THROW(Arm(pendulum(), {.watchdog = -1.0}), SetupError);
  EXPECT_THROW(Arm(pendulum(), {.watchdog = std::nan("")}), SetupError);
  EXPECT_NO_THROW(Arm(pendulum(), {.watchdog = infinity}));
}

}  // namespace brake_test
}  // namespace repel::bullet
