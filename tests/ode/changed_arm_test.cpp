// SPDX-License-Identifier: BSD-3-Clause
// The ODE arm with another inertia than its model, and with a payload.
#include <gtest/gtest.h>

#include <repel/ode/arm.hpp>

#include "simulated/changed_arms.hpp"

namespace repel::ode {
namespace changed_arm_test {

constexpr auto make = [](const ArmModel& model) { return Arm(model); };

TEST(OdeArmWithAnotherInertia, AcceleratesInInverseProportion) {
  simulated::expect_inertia_to_divide_the_acceleration(make, 1e-5);
}

TEST(OdeArmWithAnotherInertia, IsHeldByTheTorquesThatHoldItsModel) {
  simulated::expect_to_be_held(make);
}

TEST(OdeArmWithAPayload, AcceleratesByTheWeightAndInertiaOfBoth) {
  simulated::expect_the_payload_to_pull(make, 1e-5);
}

}  // namespace changed_arm_test
}  // namespace repel::ode
