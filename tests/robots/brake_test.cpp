// SPDX-License-Identifier: BSD-3-Clause
// The drive and the brakes of the reference arm.
#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/robots/urdf.hpp>

#include "simulated/brakes.hpp"

namespace repel {
namespace brake_test {

using namespace simulated;

auto maker(const ArmModel& model, const std::vector<double>& start) {
  return [=](double seconds) {
    ReferenceArm arm(model, {.substeps = 4, .watchdog = seconds});
    arm.reset(start);
    return arm;
  };
}

TEST(ReferenceBrakes, APumaStopsAndStandsAndGoesOn) {
  expect_a_sound_drive(maker(heavy_puma(), puma_start()), puma_push());
}

TEST(ReferenceBrakes, AnArmOfWhoseMotorsNothingIsKnownDoesSoToo) {
  expect_a_sound_drive(maker(light_arm(), std::vector(6, 0.5)), light_push());
}

TEST(ReferenceBrakes, TheLongReachStopsAndStandsByItsLimitsOfEffort) {
  const ArmModel model = load_arm("robots/long_reach.urdf").arm;
  expect_a_sound_drive(maker(model, {2.5, 0.3, 0.8, -0.9, 0.2, 0.5, 0.1}),
                       {200.0, 20.0, 100.0, 50.0, 1.0, 1.0, 0.1});
}

TEST(ReferenceBrakes, ALongChainStretchedOutDoesNotCreep) {
  expect_brakes_to_hold(maker(chain(), std::vector(8, 0.0)), std::vector(8, 0.0));
}

TEST(ReferenceBrakes, AStopForgetsWhatWasSent) {
  expect_a_stop_to_forget_what_was_sent(maker(turntable(0.5), {0.0}));
}

TEST(ReferenceBrakes, ABrakeSlowsByItsOwnTorqueAndLetsABiggerLoadSlip) {
  ArmModel model = pendulum();
  model.links[0].brake_torque = 3.0;
  model.links[0].coulomb_friction = 1.0;
  ReferenceArm arm(model, {.substeps = 1});
  arm.reset(std::vector{pi / 2});
  arm.engage_brakes(true);
  arm.step(1e-6);
  EXPECT_NEAR(velocities(arm)[0] / 1e-6, -(2.0 * 9.81 * 0.5 - 4.0) / 0.53, 1e-4);
  EXPECT_THROW((ReferenceArm{pendulum(), {.watchdog = -1.0}}), SetupError);
}

}  // namespace brake_test
}  // namespace repel
