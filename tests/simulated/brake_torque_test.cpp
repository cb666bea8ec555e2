// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/brake_torque.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace repel {
namespace brake_torque_test {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Two links of 2 kg, 0.5 m long; the second rotates 0.4 m beyond the first.
ArmModel two_links() {
  ArmModel model;
  for (int i = 0; i < 2; ++i) {
    ArmLink link;
    link.mass = 2.0;
    link.p_LC = Vec3(0.5, 0, 0);
    link.lower = -3.0;
    link.upper = 3.0;
    model.links.push_back(link);
  }
  model.links[1].X_PJ.translation() = Vec3(0, 0.4, 0);
  return model;
}

TEST(BrakeTorque, IsTheBrakesOwnOrOneAndAHalfTimesTheEffortLimit) {
  ArmModel model = two_links();
  model.links[0].effort_limit = 40.0;
  EXPECT_EQ(brake_torque(model, 0), 60.0);
  model.links[0].brake_torque = 7.0;
  EXPECT_EQ(brake_torque(model, 0), 7.0);
}

TEST(BrakeTorque, CarriesWhatTheJointCarriesStretchedOutWhereNothingIsKnown) {
  ArmModel model = two_links();
  const double outer = 2.0 * 9.81 * 2.0 * 0.5 + 2.0 * 0.25 * 3.0 / 0.25;
  EXPECT_NEAR(brake_torque(model, 1), outer, 1e-12);
  const double inner = 2.0 * 9.81 * 2.0 * (0.5 + 0.9) + 2.0 * (0.25 + 0.81) * 3.0 / 0.25;
  EXPECT_NEAR(brake_torque(model, 0), inner, 1e-12);
  model.links[1].velocity_limit = 1.0;
  model.links[1].rotor_inertia = 1.0;
  EXPECT_NEAR(brake_torque(model, 1), 2.0 * 9.81 * 2.0 * 0.5 + 1.5 / 0.25, 1e-12);
}

TEST(BrakeTorque, CountsHowFarASlidingJointReachesAndHoldsWhatHangsOnIt) {
  ArmModel model = two_links();
  model.links[1].type = JointType::prismatic;
  const double slid = 2.0 * 9.81 * 2.0 * (0.5 + 3.9) + 2.0 * (0.25 + 3.9 * 3.9) * 3.0 / 0.25;
  EXPECT_NEAR(brake_torque(model, 0), slid, 1e-12);
  EXPECT_NEAR(brake_torque(model, 1), 2.0 * 9.81 * 2.0 + 2.0 * 1.0 / 0.25, 1e-12);
  model.links[1].upper = inf;
  EXPECT_EQ(brake_torque(model, 0), inf);
  model.links[1].mass = 0.0;
  EXPECT_TRUE(std::isfinite(brake_torque(model, 0))) << "no weight, however far";
}

}  // namespace brake_torque_test
}  // namespace repel
