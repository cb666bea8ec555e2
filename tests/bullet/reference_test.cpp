// The Bullet arm against the equations of motion solved to a high order.
#include <gtest/gtest.h>

#include <repel/robots/dynamics.hpp>

#include "arms.hpp"
#include "simulated/motions.hpp"

namespace repel::bullet::test {
namespace reference_test {

TEST(BulletAgainstTheReference, PumaMovesAlikeToFirstOrderInTheSubStep) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) {  // the reference has no stops
    link.lower = -kInfinity;
    link.upper = kInfinity;
  }
  const auto reference = motion_of(ReferenceArm(model, {.substeps = 8}));
  EXPECT_LT(apart(reference, motion_of(ReferenceArm(model, {.substeps = 16}))), 1e-9);
  EXPECT_GT(apart(reference, {400, reference[0]}), 1.0) << "it must have moved";
  const auto error = [&](int substeps) {
    return apart(reference, motion_of(Arm(model, {.substeps = substeps})));
  };
  const double four = error(4);
  const double sixteen = error(16);
  EXPECT_LT(four, 5e-3);
  EXPECT_NEAR(sixteen / four, 0.25, 0.05);
  EXPECT_NEAR(error(64) / sixteen, 0.25, 0.05);
}

}  // namespace reference_test
}  // namespace repel::bullet::test
