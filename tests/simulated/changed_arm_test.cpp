// SPDX-License-Identifier: BSD-3-Clause
// The models of arms with another inertia and with a payload.
#include <repel/simulated/changed_arm.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <repel/simulated/brake_torque.hpp>

#include "simulated/arms.hpp"

namespace repel {
namespace changed_arm_test {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Inertia of a link [kg m^2] about the origin of its frame.
Mat3 inertia_about_origin(const ArmLink& link) {
  const Vec3& p = link.p_LC;
  return link.I_C_L + link.mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

ArmModel arm_with_tool() {
  ArmModel model = simulated::puma560();
  model.X_LT = Eigen::Translation3d(0.1, -0.2, 0.3) *
               Pose(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -1.0).normalized()));
  return model;
}

TEST(WithInertia, MultipliesMassesAndInertiasAndKeepsTheWeightAndAllElse) {
  const ArmModel model = arm_with_tool();
  for (const double factor : {0.3, 1.7, 3.0}) {
    const ArmModel changed = with_inertia(model, factor);
    ASSERT_EQ(changed.links.size(), model.links.size());
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const ArmLink& was = model.links[i];
      const ArmLink& is = changed.links[i];
      EXPECT_DOUBLE_EQ(is.mass, factor * was.mass);
      EXPECT_TRUE(is.I_C_L.isApprox(factor * was.I_C_L, 1e-15));
      EXPECT_DOUBLE_EQ(is.rotor_inertia, factor * was.rotor_inertia);
      EXPECT_TRUE((is.mass * changed.gravity_W).isApprox(was.mass * model.gravity_W, 1e-15));
      EXPECT_EQ(is.p_LC, was.p_LC);
      EXPECT_EQ(is.viscous_friction, was.viscous_friction);
      EXPECT_EQ(is.lower, was.lower);
      EXPECT_EQ(is.upper, was.upper);
    }
  }
}

TEST(WithInertia, OfOneChangesNoNumberOfTheMotion) {
  const ArmModel model = arm_with_tool();
  const ArmModel same = with_inertia(model, 1.0);
  EXPECT_EQ(same.gravity_W, model.gravity_W);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    EXPECT_EQ(same.links[i].mass, model.links[i].mass);
    EXPECT_EQ(same.links[i].I_C_L, model.links[i].I_C_L);
    EXPECT_EQ(same.links[i].rotor_inertia, model.links[i].rotor_inertia);
  }
}

TEST(WithInertia, RefusesAFactorOutOfRangeAndNamesTheRange) {
  const ArmModel model = arm_with_tool();
  for (const double factor : {0.29, 3.01, 0.0, -1.0, not_a_number, infinity}) {
    EXPECT_THROW((void)with_inertia(model, factor), SetupError) << factor;
  }
  try {
    (void)with_inertia(model, 4.0);
    ADD_FAILURE() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("is 4; allowed: 0.3 to 3"), std::string::npos)
        << error.what();
  }
}

TEST(WithPayload, AddsAPointMassAtItsPlaceInTheToolFrame) {
  const ArmModel model = arm_with_tool();
  const Payload payload{2.5, {0.05, -0.02, 0.4}};
  const ArmModel changed = with_payload(model, payload);
  const ArmLink& was = model.links.back();
  const ArmLink& is = changed.links.back();
  const Vec3 p_LP = model.X_LT * payload.p_TC;
  EXPECT_DOUBLE_EQ(is.mass, was.mass + 2.5);
  EXPECT_TRUE((is.mass * is.p_LC).isApprox(was.mass * was.p_LC + 2.5 * p_LP, 1e-14));
  const Mat3 point = 2.5 * (p_LP.squaredNorm() * Mat3::Identity() - p_LP * p_LP.transpose());
  EXPECT_TRUE(inertia_about_origin(is).isApprox(inertia_about_origin(was) + point, 1e-14));
  EXPECT_EQ(is.rotor_inertia, was.rotor_inertia);
  EXPECT_EQ(changed.gravity_W, model.gravity_W);
  for (std::size_t i = 0; i + 1 < model.links.size(); ++i) {
    EXPECT_EQ(changed.links[i].mass, model.links[i].mass);
    EXPECT_EQ(changed.links[i].p_LC, model.links[i].p_LC);
    EXPECT_EQ(changed.links[i].I_C_L, model.links[i].I_C_L);
  }
}

TEST(WithPayload, OfALinkWithoutMassIsThePayload) {
  ArmModel model = arm_with_tool();
  model.links.back().mass = 0.0;
  const ArmLink link = with_payload(model, {2.0, {0, 0, 0.1}}).links.back();
  EXPECT_EQ(link.mass, 2.0);
  EXPECT_TRUE(link.p_LC.isApprox(model.X_LT * Vec3(0, 0, 0.1), 1e-15));
  EXPECT_EQ(link.I_C_L, model.links.back().I_C_L);
}

TEST(WithPayload, OfNothingChangesNothing) {
  ArmModel model = arm_with_tool();
  model.links.back().mass = 0.0;  // no mass to divide by
  const ArmLink link = with_payload(model, {0.0, {0, 0, 1.0}}).links.back();
  EXPECT_EQ(link.mass, 0.0);
  EXPECT_EQ(link.p_LC, model.links.back().p_LC);
  EXPECT_EQ(link.brake_torque, 0.0) << "still unknown";
}

TEST(WithPayload, RefusesWhatIsOutOfRange) {
  const ArmModel model = arm_with_tool();
  for (const double mass : {-1e-9, 100.1, not_a_number, infinity}) {
    EXPECT_THROW((void)with_payload(model, {mass, {0, 0, 0}}), SetupError) << mass;
  }
  for (const double far : {-10.1, 10.1, not_a_number, infinity}) {
    EXPECT_THROW((void)with_payload(model, {1.0, {0, far, 0}}), SetupError) << far;
  }
  EXPECT_THROW((void)with_payload(ArmModel{}, {1.0, {0, 0, 0}}), SetupError) << "no link";
}

TEST(ChangedArm, KeepsItsBrakes) {
  ArmModel model = simulated::light_arm();  // nothing says how strong they are
  model.links[0].effort_limit = 40.0;
  model.links[1].brake_torque = 7.0;
  const ArmModel heavy = with_inertia(with_payload(model, {100.0, {0, 0, 1}}), 3.0);
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    EXPECT_EQ(brake_torque(heavy, i), brake_torque(model, i)) << i;
  }
  model.links[3].type = JointType::prismatic;  // without stops: no bound for the joints before it
  EXPECT_EQ(brake_torque(model, 2), infinity);
  EXPECT_EQ(brake_torque(with_inertia(model, 3.0), 2), infinity);
}

}  // namespace changed_arm_test
}  // namespace repel
