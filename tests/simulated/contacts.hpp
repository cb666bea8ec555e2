// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tests for every engine with physical contact.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/simulated/contact.hpp>

#include "simulated/arms.hpp"

namespace repel::simulated {

inline Pose at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

/// A sledge of 2 kg on a rail along x, without weight or friction.
inline ArmModel sledge() {
  ArmModel model;
  model.name = "sledge";
  model.links.push_back(link_with(2.0, Vec3::Zero(), {0.01, 0.01, 0.01}));
  model.links[0].type = JointType::prismatic;
  model.links[0].axis_J = Vec3::UnitX();
  return model;
}

/// Parts of a link that extend 0.1 m along x from its origin.
inline std::vector<ContactPart> probes() {
  return {{"box", 0, Shape::box({0.1, 0.05, 0.03}), Pose::Identity()},
          {"sphere", 0, Shape::sphere(0.1), Pose::Identity()},
          {"capsule", 0, Shape::capsule(0.1, 0.2), Pose::Identity()},
          {"cylinder", 0, Shape::cylinder(0.1, 0.2), Pose::Identity()}};
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

/// A box in the path of a sledge with `part`.
template <class Arm>
void expect_a_box_stops(const ContactPart& part) {
  const ContactPart wall{"wall", -1, Shape::box({0.2, 0.5, 0.5}), at(0.5, 0, 0)};
  expect_stop<Arm>({part, wall}, 0.2, part.name);
}

/// The shape of `part` as an obstacle in the path of a transverse capsule.
template <class Arm>
void expect_it_stops_a_capsule(ContactPart part) {
  part.link = -1;
  part.X_LP = at(0.5, 0, 0);
  ContactPart rod{"rod", 0, Shape::capsule(0.02, 0.2), Pose::Identity()};
  rod.X_LP.linear() = Eigen::AngleAxisd(pi / 2, Vec3::UnitX()).toRotationMatrix();
  expect_stop<Arm>({rod, part}, 0.38, part.name);
}

/// Forearm and hand of a PUMA, and a table onto which they fall from `above_the_table`.
inline std::vector<ContactPart> forearm_hand_and_table() {
  return {{"forearm", 2, Shape::capsule(0.05, 0.2), Pose::Identity()},
          {"hand", 5, Shape::box({0.04, 0.04, 0.1}), Pose::Identity()},
          {"table", -1, Shape::box({2.0, 2.0, 0.1}), at(0, 0, -0.4)}};
}
inline std::vector<double> above_the_table() {
  return {0.0, 0.6, -0.6, 0.2, 0.3, 0.0};
}

/// Two arms that fall onto the table move bitwise alike.
template <class Arm>
void expect_the_same_again(const ArmModel& model) {
  Arm one(model, {}, forearm_hand_and_table());
  Arm two(model, {}, forearm_hand_and_table());
  for (Arm* arm : {&one, &two}) {
    arm->reset(above_the_table());
    for (int tick = 0; tick < 800; ++tick) arm->step(1.0 / 400);
  }
  EXPECT_GT(one.contact().steps, 0);
  EXPECT_EQ(positions(one), positions(two));
  EXPECT_EQ(velocities(one), velocities(two));
  EXPECT_EQ(one.contact().deepest, two.contact().deepest);
}

/// An arm that falls onto the table comes to rest.
template <class Arm>
void expect_to_rest_on_a_table(const ArmModel& model) {
  Arm arm(model, {}, forearm_hand_and_table());
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

/// A sensor on the sledge reads what holds it: 50 N along x, at a
/// tool that is turned and does not lie in the line of the force.
template <class Arm>
void expect_its_wrench_to_hold_the_sledge() {
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

/// On a link that does not carry the tool nothing is measured.
template <class Arm>
void expect_no_wrench_of_other_links() {
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

/// Parts out of reach leave the motion bitwise unchanged.
template <class Arm>
void expect_untouched_the_same(const ArmModel& model) {
  const std::vector<ContactPart> parts{{"hand", 5, Shape::box({0.04, 0.04, 0.1}), Pose::Identity()},
                                       {"far", -1, Shape::box({0.1, 0.1, 0.1}), at(5, 0, 0)}};
  Arm plain(model);
  Arm touching(model, {}, parts);
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

}  // namespace repel::simulated
