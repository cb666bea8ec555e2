// SPDX-License-Identifier: BSD-3-Clause
// The drive and the brakes of every simulated arm.
#include <gtest/gtest.h>

#include <cmath>

#include <repel/base/setup_error.hpp>
#ifdef REPEL_TESTS_Robots
#include <repel/robots/urdf.hpp>
#endif

#include "engines/arms.hpp"
#include "simulated/brakes.hpp"

namespace repel::simulated {
namespace brake_test {

template <class Tested>
struct Brakes : testing::Test {
  static auto maker(const ArmModel& model, const std::vector<double>& start) {
    return [=](double seconds) {
      typename Tested::Arm arm(model, {.substeps = 4, .watchdog = seconds});
      arm.reset(start);
      return arm;
    };
  }
};
TYPED_TEST_SUITE(Brakes, EveryArm);

TYPED_TEST(Brakes, APumaStopsAndStandsAndGoesOn) {
  expect_a_sound_drive(this->maker(TypeParam::puma(), puma_start()), puma_push());
}

TYPED_TEST(Brakes, AnArmOfWhoseMotorsNothingIsKnownDoesSoToo) {
  expect_a_sound_drive(this->maker(light_arm(), std::vector(6, 0.5)), light_push());
}

#ifdef REPEL_TESTS_Robots
TYPED_TEST(Brakes, TheLongReachStopsAndStandsByItsLimitsOfEffort) {
  const ArmModel model = load_arm("robots/long_reach.urdf").arm;
  expect_a_sound_drive(this->maker(model, {2.5, 0.3, 0.8, -0.9, 0.2, 0.5, 0.1}),
                       {200.0, 20.0, 100.0, 50.0, 1.0, 1.0, 0.1});
}
#endif

TYPED_TEST(Brakes, ALongChainStretchedOutDoesNotCreep) {
  expect_brakes_to_hold(this->maker(chain(), std::vector(8, 0.0)), std::vector(8, 0.0));
}

TYPED_TEST(Brakes, AStopForgetsWhatWasSent) {
  expect_a_stop_to_forget_what_was_sent(this->maker(turntable(0.5), {0.0}));
}

TYPED_TEST(Brakes, ABrakeSlowsByItsOwnTorqueAndLetsABiggerLoadSlip) {
  ArmModel model = pendulum();
  model.links[0].brake_torque = 3.0;
  model.links[0].coulomb_friction = 1.0;
  typename TypeParam::Arm arm(model, {.substeps = 1});
  arm.reset(std::vector{pi / 2});
  arm.engage_brakes(true);
  arm.step(1e-6);
  EXPECT_NEAR(velocities(arm)[0] / 1e-6, -(2.0 * 9.81 * 0.5 - 4.0) / 0.53, TypeParam::braked);
}

TYPED_TEST(Brakes, SetUpNamesTheWatchdogThatIsOutOfRange) {
  EXPECT_THROW(this->maker(pendulum(), {0.0})(-1.0), SetupError);
  EXPECT_THROW(this->maker(pendulum(), {0.0})(std::nan("")), SetupError);
  EXPECT_NO_THROW(this->maker(pendulum(), {0.0})(infinity));
}

}  // namespace brake_test
}  // namespace repel::simulated
