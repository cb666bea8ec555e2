// SPDX-License-Identifier: BSD-3-Clause
// Physical contact in every engine: obstacles stop its arm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/simulated/contact.hpp>

#include "engines/arms.hpp"

namespace repel::simulated {
namespace contact_test {

template <class Engine>
struct Contact : testing::Test {};
TYPED_TEST_SUITE(Contact, EveryEngine);

Pose at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

/// A sledge of 2 kg on a rail along x, without weight or friction.
ArmModel sledge() {
  ArmModel model;
  model.name = "sledge";
  model.links.push_back(link_with(2.0, Vec3::Zero(), {0.01, 0.01, 0.01}));
  model.links[0].type = JointType::prismatic;
  model.links[0].axis_J = Vec3::UnitX();
  return model;
}

/// Parts of a link that extend 0.1 m along x from its origin.
template <class Engine>
std::vector<ContactPart> probes() {
  std::vector<ContactPart> parts{{"box", 0, Shape::box({0.1, 0.05, 0.03}), Pose::Identity()},
                                 {"sphere", 0, Shape::sphere(0.1), Pose::Identity()},
                                 {"capsule", 0, Shape::capsule(0.1, 0.2), Pose::Identity()},
                                 {"cylinder", 0, Shape::cylinder(0.1, 0.2), Pose::Identity()}};
  if (!Engine::touches_hulls) return parts;
  std::vector<Vec3> corners;
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.1, 0.1}) {
      for (const double z : {-0.05, 0.05}) corners.emplace_back(x, y, z);
    }
  }
  parts.push_back({"hull", 0, Shape::hull(corners), Pose::Identity()});
  const Pose on_side(Eigen::AngleAxisd(pi / 2, Vec3::UnitY()));  // its z axis is a corner
  parts.push_back({"ellipsoid", 0, Shape::ellipsoid({0.2, 0.05, 0.1}), on_side});
  return parts;
}

/// Pushes the sledge with 50 N, from 0.3 m/s, for two seconds, against a stop at `stop` [m].
template <class Arm>
void expect_stop(const std::vector<ContactPart>& parts, double stop, const std::string& which) {
  Arm arm(sledge(), {}, parts);
  arm.reset(std::vector{0.0}, std::vector{0.3});
  arm.set_torques(std::vector{50.0});
  for (int tick = 0; tick < 800; ++tick) {
    arm.step(1.0 / 400);
    ASSERT_LT(positions(arm)[0], stop + 0.002) << which << ", tick " << tick;
  }
  EXPECT_NEAR(positions(arm)[0], stop, 2e-4) << which;
  EXPECT_LT(std::abs(velocities(arm)[0]), 1e-4) << which;
  EXPECT_GT(arm.contact().steps, 600) << which;
  EXPECT_LT(arm.contact().deepest, 0.002) << which;
  EXPECT_GT(arm.contact().deepest, 1e-6) << which;
  arm.reset(std::vector{0.0});
  EXPECT_EQ(arm.contact().steps, 0) << which;
  EXPECT_EQ(arm.contact().deepest, 0.0) << which;
}

TYPED_TEST(Contact, ABoxHoldsEveryShapeThatIsPushedIntoIt) {
  const ContactPart wall{"wall", -1, Shape::box({0.2, 0.5, 0.5}), at(0.5, 0, 0)};
  std::vector<ContactPart> parts = probes<TypeParam>();
  if (TypeParam::touches_cones) {
    for (const double turn : {pi / 2, -pi / 2}) {  // the tip and the base of a cone
      parts.push_back({"cone", 0, Shape::cone(0.05, 0.1), Pose::Identity()});
      parts.back().X_LP.linear() = Eigen::AngleAxisd(turn, Vec3::UnitY()).toRotationMatrix();
    }
  }
  for (const ContactPart& part : parts) {
    expect_stop<typename TypeParam::Arm>({part, wall}, 0.2, part.name);
  }
}

TYPED_TEST(Contact, EveryShapeHoldsATransverseCapsule) {
  ContactPart rod{"rod", 0, Shape::capsule(0.02, 0.2), Pose::Identity()};
  rod.X_LP.linear() = Eigen::AngleAxisd(pi / 2, Vec3::UnitX()).toRotationMatrix();
  for (ContactPart part : probes<TypeParam>()) {
    part.link = -1;
    part.X_LP = at(0.5, 0, 0) * part.X_LP;
    expect_stop<typename TypeParam::Arm>({rod, part}, 0.38, part.name);
  }
}

/// Forearm and hand of a PUMA, and a table onto which they fall from `above_the_table`.
std::vector<ContactPart> forearm_hand_and_table() {
  return {{"forearm", 2, Shape::capsule(0.05, 0.2), Pose::Identity()},
          {"hand", 5, Shape::box({0.04, 0.04, 0.1}), Pose::Identity()},
          {"table", -1, Shape::box({2.0, 2.0, 0.1}), at(0, 0, -0.4)}};
}
std::vector<double> above_the_table() {
  return {0.0, 0.6, -0.6, 0.2, 0.3, 0.0};
}

TYPED_TEST(Contact, TheSameFallGivesTheSameBits) {
  using Arm = typename TypeParam::Arm;
  Arm one(TypeParam::puma(), {}, forearm_hand_and_table());
  Arm two(TypeParam::puma(), {}, forearm_hand_and_table());
  for (Arm* arm : {&one, &two}) {
    arm->reset(above_the_table());
    for (int tick = 0; tick < 800; ++tick) arm->step(1.0 / 400);
  }
  EXPECT_GT(one.contact().steps, 0);
  EXPECT_EQ(positions(one), positions(two));
  EXPECT_EQ(velocities(one), velocities(two));
  EXPECT_EQ(one.contact().deepest, two.contact().deepest);
}

TYPED_TEST(Contact, APumaThatFallsComesToRestOnATable) {
  using Arm = typename TypeParam::Arm;
  Arm arm(TypeParam::puma(), {}, forearm_hand_and_table());
  arm.reset(above_the_table());
  std::vector<double> before(6);
  for (int tick = 0; tick < 4000; ++tick) {
    if (tick == 3600) before = positions(arm);
    arm.step(1.0 / 400);
    for (const double q : positions(arm)) ASSERT_TRUE(std::isfinite(q)) << tick;
  }
  const std::vector<double> after = positions(arm);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(after[i], before[i], 0.02) << i;
  EXPECT_GT(arm.contact().steps, 1000);
  EXPECT_LT(arm.contact().deepest, 0.02);
  EXPECT_FALSE(arm.faults().state);
}

/// 50 N along x, at a tool that is turned and does not lie in the line of the force.
TYPED_TEST(Contact, SensorReadsWhatHoldsTheTool) {
  using Arm = typename TypeParam::Arm;
  ArmModel model = sledge();
  model.links[0].p_LC = Vec3(0.03, 0.0, 0.0);
  model.X_LT = at(0.2, 0.1, 0.3);
  model.X_LT.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3.0).toRotationMatrix();
  const std::vector<ContactPart> parts{{"ball", 0, Shape::sphere(0.1), Pose::Identity()},
                                       {"wall", -1, Shape::box({0.2, 0.5, 0.5}), at(0.5, 0, 0)}};
  Arm arm(model, {}, parts);
  arm.reset(std::vector{0.0});
  arm.set_torques(std::vector{50.0});
  arm.step(1.0 / 400);
  ASSERT_TRUE(arm.read_wrench());
  EXPECT_EQ(arm.read_wrench()->force, Vec3::Zero()) << "it touches nothing yet";
  for (int tick = 0; tick < 800; ++tick) arm.step(1.0 / 400);
  const Wrench F_W = rotated(model.X_LT.linear(), *arm.read_wrench());
  // At the contact, x is 0.1 m; the tool is at (0.2, 0.1, 0.3) from the origin of the link.
  const Wrench expected = wrench_of_force(Vec3(-50.0, 0, 0), Vec3(-0.1, -0.1, -0.3));
  EXPECT_LT((F_W.force - expected.force).norm(), 0.01) << F_W.force.transpose();
  EXPECT_LT((F_W.torque - expected.torque).norm(), 0.01) << F_W.torque.transpose();
  arm.reset(std::vector{0.0});
  EXPECT_EQ(arm.read_wrench()->force, Vec3::Zero());
  const Arm alone(model);
  ASSERT_TRUE(alone.read_wrench());
  EXPECT_EQ(alone.read_wrench()->force, Vec3::Zero());
}

TYPED_TEST(Contact, SensorMeasuresNothingOfALinkThatDoesNotCarryTheTool) {
  using Arm = typename TypeParam::Arm;
  ArmModel model = sledge();
  model.links.push_back(link_with(0.5, Vec3::Zero(), {0.01, 0.01, 0.01}));
  model.links[1].axis_J = Vec3::UnitX();
  const std::vector<ContactPart> parts{{"ball", 0, Shape::sphere(0.1), Pose::Identity()},
                                       {"wall", -1, Shape::box({0.2, 0.5, 0.5}), at(0.5, 0, 0)}};
  Arm arm(model, {}, parts);
  arm.reset(std::vector{0.0, 0.0});
  arm.set_torques(std::vector{50.0, 0.0});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  EXPECT_GT(arm.contact().steps, 0);
  EXPECT_EQ(arm.read_wrench()->force, Vec3::Zero());
}

TYPED_TEST(Contact, WhatIsNotTouchedChangesNoBit) {
  using Arm = typename TypeParam::Arm;
  const std::vector<ContactPart> parts{{"hand", 5, Shape::box({0.04, 0.04, 0.1}), Pose::Identity()},
                                       {"far", -1, Shape::box({0.1, 0.1, 0.1}), at(5, 0, 0)}};
  Arm plain(TypeParam::puma());
  Arm touching(TypeParam::puma(), {}, parts);
  for (int tick = 0; tick < 400; ++tick) {
    const std::vector<double> torques(6, 5.0 * std::sin(0.05 * tick));
    for (Arm* arm : {&plain, &touching}) {
      arm->set_torques(torques);
      arm->step(1.0 / 400);
    }
  }
  EXPECT_EQ(positions(plain), positions(touching));
  EXPECT_EQ(velocities(plain), velocities(touching));
  EXPECT_EQ(touching.contact().steps, 0);
}

TYPED_TEST(Contact, SetUpNamesThePartThatCannotBeTouched) {
  std::vector<Shape> shapes{Shape::box({0.1, 0.1, 0.0})};
  if (!TypeParam::touches_cones) shapes.push_back(Shape::cone(0.1, 0.1));
  if (!TypeParam::touches_hulls) {
    shapes.push_back(Shape::hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}));
  }
  for (const Shape& shape : shapes) {
    const std::vector<ContactPart> parts{{"spike", -1, shape, Pose::Identity()}};
    try {
      const typename TypeParam::Arm arm(TypeParam::puma(), {}, parts);
      FAIL() << "nothing was thrown";
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("'spike'"), std::string::npos) << error.what();
    }
  }
}

}  // namespace contact_test
}  // namespace repel::simulated
