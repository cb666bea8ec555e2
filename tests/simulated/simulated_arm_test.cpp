// SPDX-License-Identifier: BSD-3-Clause
// Arms that an engine refuses to simulate, and the error messages.
#include <gtest/gtest.h>

#include <limits>

#include <repel/simulated/simulated_arm.hpp>

namespace repel {
namespace simulated_arm_test {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

ArmModel sound() {
  ArmModel model;
  model.name = "arm";
  ArmLink link;
  link.joint_name = "elbow";
  link.mass = 1.0;
  link.I_C_L = Mat3::Identity();
  link.upper = 1.0;
  model.links.push_back(link);
  return model;
}

/// The error message for a valid arm after `spoil`.
template <class Spoil>
std::string complaint(Spoil spoil) {
  ArmModel model = sound();
  spoil(model, model.links[0]);
  try {
    require_simulable(model);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SimulatedArm, NamesTheJointAndTheNumber) {
  EXPECT_EQ(complaint([](ArmModel&, ArmLink&) {}), "accepted");
  const auto expect = [](const std::string& words, auto spoil) {
    const std::string text = complaint(spoil);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  expect("'elbow': mass is -1 kg", [](ArmModel&, ArmLink& l) { l.mass = -1.0; });
  expect("'elbow': rotor", [](ArmModel&, ArmLink& l) { l.rotor_inertia = not_a_number; });
  expect("'elbow': viscous", [](ArmModel&, ArmLink& l) { l.viscous_friction = -1.0; });
  expect("'elbow': Coulomb", [](ArmModel&, ArmLink& l) { l.coulomb_friction = -1.0; });
  expect("'elbow': brake", [](ArmModel&, ArmLink& l) { l.brake_torque = -1.0; });
  expect("'elbow': axis_J", [](ArmModel&, ArmLink& l) { l.axis_J *= 2.0; });
  expect("'elbow': X_PJ", [](ArmModel&, ArmLink& l) { l.X_PJ.linear() *= 2.0; });
  expect("centre of mass", [](ArmModel&, ArmLink& l) { l.p_LC.x() = not_a_number; });
  expect("symmetric", [](ArmModel&, ArmLink& l) { l.I_C_L(0, 1) = 0.5; });
  expect("negative principal", [](ArmModel&, ArmLink& l) { l.I_C_L(2, 2) = -1.0; });
  expect("limits are 1 to 1", [](ArmModel&, ArmLink& l) { l.lower = 1.0; });
  expect("'arm' has no links", [](ArmModel& m, ArmLink&) { m.links.clear(); });
  expect("X_WB", [](ArmModel& m, ArmLink&) { m.X_WB.linear() *= 2.0; });
  expect("gravity", [](ArmModel& m, ArmLink&) { m.gravity_W.x() = not_a_number; });
}

TEST(SimulatedArm, OptionsAndStatesOutOfRangeAreRefused) {
  EXPECT_NO_THROW(require_valid(SimulationOptions{}));
  EXPECT_THROW(require_valid({.substeps = 0}), SetupError);
  EXPECT_THROW(require_valid({.stop_stiffness = -1.0}), SetupError);
  EXPECT_THROW(require_valid({.stop_damping = not_a_number}), SetupError);
  EXPECT_THROW(require_valid({.contact_stiffness = -1.0}), SetupError);
  EXPECT_THROW(require_valid({.contact_damping = 0.0}), SetupError);
  EXPECT_THROW(require_valid({.contact_friction = not_a_number}), SetupError);
  EXPECT_THROW(require_valid({.watchdog = -0.1}), SetupError);
  EXPECT_THROW(require_valid({.watchdog = not_a_number}), SetupError);
  const ArmModel model = sound();
  const double inside[] = {0.5};
  const double outside[] = {1.5};
  const double none[] = {not_a_number};
  const double two[] = {0.5, 0.5};
  EXPECT_NO_THROW(require_state(model, inside, {}));
  EXPECT_NO_THROW(require_state(model, inside, outside)) << "a speed has no limit";
  EXPECT_THROW(require_state(model, outside, {}), SetupError);
  EXPECT_THROW(require_state(model, none, {}), SetupError);
  EXPECT_THROW(require_state(model, inside, none), SetupError);
  EXPECT_THROW(require_state(model, two, {}), SetupError);
  EXPECT_THROW(require_state(model, inside, two), SetupError);
}

}  // namespace simulated_arm_test
}  // namespace repel
