// SPDX-License-Identifier: BSD-3-Clause
// Physical contact in the Bullet arm: obstacles stop it.
#include <repel/reduction/shape.hpp>
#include "simulated/contacts.hpp"

#include <gtest/gtest.h>

#include "arms.hpp"

namespace repel::bullet::test {
namespace contact_test {

/// All shapes with a face 0.1 m from their origins along x.
std::vector<ContactPart> all_probes() {
  std::vector<ContactPart> parts = probes();
  std::vector<Vec3> corners;
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.1, 0.1}) {
      for (const double z : {-0.05, 0.05}) corners.emplace_back(x, y, z);
    }
  }
  parts.push_back({"hull", 0, Shape::hull(corners), Pose::Identity()});
  return parts;
}

TEST(BulletContact, ABoxHoldsEveryShapeThatIsPushedIntoIt) {
  for (const ContactPart& part : all_probes()) expect_a_box_stops<Arm>(part);
}

TEST(BulletContact, EveryShapeHoldsACapsule) {
  for (const ContactPart& part : all_probes()) expect_it_stops_a_capsule<Arm>(part);
}

TEST(BulletContact, APumaThatFallsComesToRestOnATable) {
  expect_to_rest_on_a_table<Arm>(puma560());
}

TEST(BulletContact, TheSameFallGivesTheSameBits) {
  expect_the_same_again<Arm>(puma560());
}

TEST(BulletContact, WhatIsNotTouchedChangesNoBit) {
  expect_untouched_the_same<Arm>(puma560());
}

TEST(BulletContact, AConeTouchesWithItsTipAndItsBase) {
  const ContactPart cone{"cone", 0, Shape::cone(0.05, 0.1), Pose::Identity()};
  for (const double turn : {pi / 2, -pi / 2}) {
    ContactPart turned = cone;
    turned.X_LP.linear() = Eigen::AngleAxisd(turn, Vec3::UnitY()).toRotationMatrix();
    expect_a_box_stops<Arm>(turned);
  }
}

TEST(BulletContact, SetUpNamesThePartThatCannotBeTouched) {
  const std::vector<ContactPart> parts{
      {"sheet", -1, Shape::box({0.1, 0.1, 0.0}), Pose::Identity()}};
  try {
    const Arm arm(puma560(), {}, parts);
    FAIL() << "nothing was thrown";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("'sheet'"), std::string::npos) << error.what();
  }
}

TEST(BulletContact, SensorReadsWhatHoldsTheTool) {
  expect_its_wrench_to_hold_the_sledge<Arm>();
  expect_no_wrench_of_other_links<Arm>();
}

}  // namespace contact_test
}  // namespace repel::bullet::test
