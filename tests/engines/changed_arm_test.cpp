// SPDX-License-Identifier: BSD-3-Clause
// Every simulated arm with another inertia than its model, and with a payload.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/simulated/changed_arm.hpp>

#include "engines/arms.hpp"

namespace repel::simulated {
namespace changed_arm_test {

template <class Tested>
struct ChangedArm : testing::Test {};
TYPED_TEST_SUITE(ChangedArm, EveryArm);

/// [s] Long enough for the rounding of ODE, short enough for the weight to stay the same.
constexpr double short_time = 1e-5;

/// A PUMA without friction and stops, so that nothing but its inertia resists a motion.
ArmModel free_puma() {
  ArmModel model = heavy_puma();
  for (ArmLink& link : model.links) {
    link.viscous_friction = 0.0;
    link.lower = -infinity;
    link.upper = infinity;
  }
  return model;
}

std::vector<double> free_puma_start() {
  return {0.2, 0.9, 0.1, -0.3, 0.4, 0.5};
}

/// The torques that hold the arm, plus `factor` times `push`.
std::vector<double> pushed(const ArmModel& model, double factor, const std::vector<double>& push) {
  std::vector<double> torques = holding_torques(model, free_puma_start());
  for (std::size_t i = 0; i < torques.size(); ++i) torques[i] += factor * push[i];
  return torques;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (const double x : b) largest = std::max(largest, std::abs(x));
  EXPECT_GT(largest, 0.1) << "it must accelerate";
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5 * largest) << i;
}

/// With `factor` times the inertia, a torque on any one joint accelerates all joints by 1 / factor,
/// and `factor` times all torques beyond those that hold it move it as before, at any speed.
TYPED_TEST(ChangedArm, AcceleratesInInverseProportionToItsInertia) {
  const ArmModel model = free_puma();
  const std::vector<double> q = free_puma_start();
  const std::vector<double> rest(q.size(), 0.0);
  const std::vector<double> v{0.5, -1.0, 0.8, 2.0, -1.5, 1.0};
  const std::vector<double> push{20.0, -30.0, 10.0, 1.0, -1.0, 0.5};
  typename TypeParam::Arm plain(model);
  for (const double factor : {0.3, 1.7, 3.0}) {
    SCOPED_TRACE(factor);
    typename TypeParam::Arm changed(with_inertia(model, factor));
    for (std::size_t joint = 0; joint < q.size(); ++joint) {
      SCOPED_TRACE(joint);
      std::vector<double> one(q.size(), 0.0);
      one[joint] = 10.0;
      std::vector<double> expected =
          accelerations(plain, q, rest, pushed(model, 1.0, one), short_time);
      for (double& a : expected) a /= factor;
      expect_near(accelerations(changed, q, rest, pushed(model, 1.0, one), short_time), expected);
    }
    expect_near(accelerations(changed, q, v, pushed(model, factor, push), short_time),
                accelerations(plain, q, v, pushed(model, 1.0, push), short_time));
  }
}

/// The torques that hold the arm of the model hold the one with another inertia for a second.
TYPED_TEST(ChangedArm, IsHeldByTheTorquesThatHoldItsModel) {
  const ArmModel model = free_puma();
  const std::vector<double> q = free_puma_start();
  for (const double factor : {0.3, 3.0}) {
    typename TypeParam::Arm arm(with_inertia(model, factor));
    arm.reset(q);
    for (int tick = 0; tick < 400; ++tick) {
      arm.set_torques(holding_torques(model, q));
      arm.step(1.0 / 400);
    }
    for (std::size_t i = 0; i < q.size(); ++i) {
      EXPECT_NEAR(positions(arm)[i], q[i], 1e-6) << "joint " << i << ", factor " << factor;
    }
  }
}

/// A pendulum with a payload accelerates by the formula of the two masses, and 1 / factor as much
/// with more inertia if gravity is all that pulls.
TYPED_TEST(ChangedArm, AcceleratesByTheWeightAndInertiaOfItsPayloadToo) {
  ArmModel model = pendulum();
  model.X_LT.translation() = Vec3(0, 0, -0.8);
  const Payload payload{3.0, {0.1, 0.05, -0.1}};
  const double x = 0.1, z = -0.9;  // [m] of the payload in the link
  const double q = 0.7;
  const double torque =
      9.81 * (3.0 * (x * std::cos(q) + z * std::sin(q)) - 2.0 * 0.5 * std::sin(q));
  const double a = torque / (0.03 + 2.0 * 0.25 + 3.0 * (x * x + z * z));
  for (const double factor : {1.0, 0.3, 3.0}) {
    typename TypeParam::Arm arm(with_inertia(with_payload(model, payload), factor));
    EXPECT_NEAR(accelerations(arm, {q}, {0.0}, {0.0}, short_time)[0], a / factor,
                1e-5 * std::abs(a));
  }
}

}  // namespace changed_arm_test
}  // namespace repel::simulated
