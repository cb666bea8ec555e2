// SPDX-License-Identifier: BSD-3-Clause
// The ODE arm compared with a high-order solution of the equations of motion.
#include <gtest/gtest.h>

#include <repel/ode/arm.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/robots/urdf.hpp>

#include "simulated/arms.hpp"
#include "simulated/brakes.hpp"
#include "simulated/motions.hpp"

namespace repel::ode {
namespace reference_test {

using namespace simulated;

/// Without stops, which the reference lacks.
ArmModel free_puma() {
  ArmModel model = heavy_puma();
  for (ArmLink& link : model.links) {
    link.lower = -infinity;
    link.upper = infinity;
  }
  return model;
}

TEST(OdeAgainstTheReference, PumaMovesAlikeToFirstOrderInTheSubStep) {
  const ArmModel model = free_puma();
  const auto reference = motion_of(ReferenceArm(model, {.substeps = 8}));
  const auto error = [&](int substeps) {
    return apart(reference, motion_of(Arm(model, {.substeps = substeps})));
  };
  const double four = error(4);
  const double sixteen = error(16);
  EXPECT_LT(four, 1e-2);
  EXPECT_NEAR(sixteen / four, 0.25, 0.05);
  EXPECT_NEAR(error(64) / sixteen, 0.25, 0.05);
}

TEST(OdeAgainstTheReference, TheLongReachStopsAndStandsByItsLimitsOfEffort) {
  const ArmModel model = load_arm("robots/long_reach.urdf").arm;
  const auto make = [&](double seconds) {
    Arm arm(model, {.watchdog = seconds});
    arm.reset(std::vector{2.5, 0.3, 0.8, -0.9, 0.2, 0.5, 0.1});
    return arm;
  };
  simulated::expect_a_sound_drive(make, {200.0, 20.0, 100.0, 50.0, 1.0, 1.0, 0.1});
}

TEST(OdeAgainstTheReference, BrakesStopAPumaWhereTheyStopTheReference) {
  const ArmModel model = simulated::heavy_puma();
  const auto stopped = [](auto arm) {
    arm.reset(simulated::puma_start());
    simulated::drive(arm, simulated::puma_push(), 80);
    arm.stop();
    simulated::leave(arm, 400);
    return positions(arm);
  };
  const auto reference = stopped(ReferenceArm(model));
  const auto here = stopped(Arm(model));
  EXPECT_LT(apart({reference}, {here}), 5e-3);
  EXPECT_GT(apart({reference}, {simulated::puma_start()}), 0.1) << "it must have moved";
}

}  // namespace reference_test
}  // namespace repel::ode
