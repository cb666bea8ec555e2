// SPDX-License-Identifier: BSD-3-Clause
// Every engine compared with a high-order solution of the equations of motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/robots/dynamics.hpp>

#include "engines/arms.hpp"
#include "simulated/brakes.hpp"

namespace repel::simulated {
namespace reference_test {

template <class Engine>
struct AgainstTheReference : testing::Test {};
TYPED_TEST_SUITE(AgainstTheReference, EveryEngine);

/// Joint positions [rad] over one second under slowly varying torques, tick by tick.
std::vector<std::vector<double>> motion_of(auto arm) {
  arm.reset(std::vector{0.2, 0.9, 0.1, -0.3, 0.4, 0.5});
  std::vector<std::vector<double>> motion;
  for (int tick = 0; tick < 400; ++tick) {
    const double s = std::sin(0.02 * tick);
    arm.set_torques(std::vector{10.0 * s, 45.0 - 20.0 * s, 8.0 * s, 1.0 * s, -1.0 * s, 0.5 * s});
    arm.step(1.0 / 400.0);
    motion.push_back(positions(arm));
  }
  return motion;
}

/// The largest difference [rad] of a joint at any tick.
double apart(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  double most = 0.0;
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    for (std::size_t i = 0; i < a[tick].size(); ++i) {
      most = std::max(most, std::abs(a[tick][i] - b[tick][i]));
    }
  }
  return most;
}

TYPED_TEST(AgainstTheReference, APumaMovesAlikeToFirstOrderInTheSubStep) {
  ArmModel model = TypeParam::puma();
  for (ArmLink& link : model.links) {  // the reference has no stops
    link.lower = -infinity;
    link.upper = infinity;
  }
  const auto reference = motion_of(ReferenceArm(model, {.substeps = 8}));
  EXPECT_LT(apart(reference, motion_of(ReferenceArm(model, {.substeps = 16}))), 1e-9);
  EXPECT_GT(apart(reference, {400, reference[0]}), 1.0) << "it must have moved";
  const auto error = [&](int substeps) {
    return apart(reference, motion_of(typename TypeParam::Arm(model, {.substeps = substeps})));
  };
  const double four = error(4);
  const double sixteen = error(16);
  EXPECT_LT(four, TypeParam::strays);
  EXPECT_NEAR(sixteen / four, 0.25, 0.05);
  EXPECT_NEAR(error(64) / sixteen, 0.25, 0.05);
}

TYPED_TEST(AgainstTheReference, BrakesStopAPumaWhereTheyStopTheReference) {
  const ArmModel model = heavy_puma();
  const auto stopped = [](auto arm) {
    arm.reset(puma_start());
    drive(arm, puma_push(), 80);
    arm.stop();
    leave(arm, 400);
    return positions(arm);
  };
  const auto reference = stopped(ReferenceArm(model));
  const auto here = stopped(typename TypeParam::Arm(model));
  EXPECT_LT(apart({reference}, {here}), 5e-3);
  EXPECT_GT(apart({reference}, {puma_start()}), 0.1) << "it must have moved";
}

}  // namespace reference_test
}  // namespace repel::simulated
