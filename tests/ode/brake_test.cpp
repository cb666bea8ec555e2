// SPDX-License-Identifier: BSD-3-Clause
// The drive and the brakes of the ODE arm.
#include <gtest/gtest.h>

#include <repel/ode/arm.hpp>

#include "simulated/brakes.hpp"

namespace repel::ode {
namespace brake_test {

using namespace simulated;

auto maker(const ArmModel& model, const std::vector<double>& start) {
  return [=](double seconds) {
    Arm arm(model, {.watchdog = seconds});
    arm.reset(start);
    return arm;
  };
}

TEST(OdeBrakes, APumaStopsAndStandsAndGoesOn) {
  expect_a_sound_drive(maker(heavy_puma(), puma_start()), puma_push());
}

TEST(OdeBrakes, AnArmOfWhoseMotorsNothingIsKnownDoesSoToo) {
  expect_a_sound_drive(maker(light_arm(), std::vector(6, 0.5)), light_push());
}

TEST(OdeBrakes, ALongChainStretchedOutDoesNotCreep) {
  expect_brakes_to_hold(maker(chain(), std::vector(8, 0.0)), std::vector(8, 0.0));
}

TEST(OdeBrakes, AStopForgetsWhatWasSent) {
  expect_a_stop_to_forget_what_was_sent(maker(turntable(0.5), {0.0}));
}

TEST(OdeBrakes, ABrakeSlowsByItsOwnTorqueAndLetsABiggerLoadSlip) {
  ArmModel model = pendulum();
  model.links[0].brake_torque = 3.0;
  model.links[0].coulomb_friction = 1.0;
  Arm arm(model, {.substeps = 1});
  arm.reset(std::vector{pi / 2});
  arm.engage_brakes(true);
  arm.step(1e-6);
  EXPECT_NEAR(velocities(arm)[0] / 1e-6, -(2.0 * 9.81 * 0.5 - 4.0) / 0.53, 1e-3);
}

}  // namespace brake_test
}  // namespace repel::ode
