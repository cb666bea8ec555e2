// The ODE arm against the equations of motion solved to a high order.
#include <gtest/gtest.h>

#include <repel/ode/arm.hpp>
#include <repel/robots/dynamics.hpp>

#include "simulated/arms.hpp"
#include "simulated/motions.hpp"

namespace repel::ode {
namespace reference_test {

using namespace simulated;

/// A PUMA whose first link has a mass, which no joint of a fixed base feels but ODE wants.
ArmModel heavy_puma() {
  ArmModel model = puma560();
  model.links[0].mass = 10.0;
  model.links[0].I_C_L = Vec3(0.35, 0.35, 0.35).asDiagonal();
  for (ArmLink& link : model.links) {  // the reference has no stops
    link.lower = -kInfinity;
    link.upper = kInfinity;
  }
  return model;
}

TEST(OdeAgainstTheReference, PumaMovesAlikeToFirstOrderInTheSubStep) {
  const ArmModel model = heavy_puma();
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

}  // namespace reference_test
}  // namespace repel::ode
