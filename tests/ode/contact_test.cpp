// SPDX-License-Identifier: BSD-3-Clause
// Physical contact in the ODE arm: obstacles stop it.
#include <gtest/gtest.h>

#include <repel/ode/arm.hpp>
#include <repel/reduction/shape.hpp>

#include "simulated/contacts.hpp"

namespace repel::ode {
namespace contact_test {

using namespace simulated;

TEST(OdeContact, ABoxHoldsEveryShapeThatIsPushedIntoIt) {
  for (const ContactPart& part : probes()) expect_a_box_stops<Arm>(part);
}

TEST(OdeContact, EveryShapeHoldsACapsule) {
  for (const ContactPart& part : probes()) expect_it_stops_a_capsule<Arm>(part);
}

TEST(OdeContact, APumaThatFallsComesToRestOnATable) {
  expect_to_rest_on_a_table<Arm>(heavy_puma());
}

TEST(OdeContact, TheSameFallGivesTheSameBits) {
  expect_the_same_again<Arm>(heavy_puma());
}

TEST(OdeContact, WhatIsNotTouchedChangesNoBit) {
  expect_untouched_the_same<Arm>(heavy_puma());
}

TEST(OdeContact, SetUpNamesThePartThatCannotBeTouched) {
  for (const Shape& shape : {Shape::cone(0.1, 0.1), Shape::box({0.1, 0.1, 0.0}),
                             Shape::hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}})}) {
    const std::vector<ContactPart> parts{{"spike", -1, shape, Pose::Identity()}};
    try {
      const Arm arm(heavy_puma(), {}, parts);
      FAIL() << "nothing was thrown";
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("'spike'"), std::string::npos) << error.what();
    }
  }
}

TEST(OdeContact, SensorReadsWhatHoldsTheTool) {
  expect_its_wrench_to_hold_the_sledge<Arm>();
  expect_no_wrench_of_other_links<Arm>();
}

}  // namespace contact_test
}  // namespace repel::ode
