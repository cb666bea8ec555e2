// SPDX-License-Identifier: BSD-3-Clause
#include "rig.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <repel/network/modules.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/simulated/changed_arm.hpp>

namespace repel::faults {
namespace {

constexpr double free_way = 0.15;  // [m] from the start to the wall

ArmModel rails() {
  ArmModel model;
  model.name = "rails";
  model.gravity_W.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    ArmLink link;
    link.name = link.joint_name = std::string(1, static_cast<char>('x' + axis));
    link.type = JointType::prismatic;
    link.axis_J = unit(axis);
    link.lower = -10.0;
    link.upper = 10.0;
    link.effort_limit = 1000.0;
    link.rotor_inertia = 5.0;
    link.viscous_friction = 20.0;
    link.coulomb_friction = 5.0;
    model.links.push_back(link);
  }
  return model;
}

std::vector<Vec3> corners(const Vec3& half, const Vec3& middle) {
  std::vector<Vec3> all;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        all.push_back(middle + Vec3(x * half.x(), y * half.y(), z * half.z()));
      }
    }
  }
  return all;
}

const Vec3 finger_half{0.012, 0.012, 0.065};
const Vec3 finger_middle{0.0, 0.0, -0.045};
const Vec3 hand_p_LP{0.0, 0.0, 0.4318};  // the middle of the wrist in link 4
constexpr double hand_radius = 0.06;

Rig puma() {
  Rig rig;
  rig.model = load_arm(REPEL_SOURCE "/robots/puma560.urdf").arm;
  rig.model.X_LT = rig.model.X_LT * Eigen::Translation3d(0.0, 0.0, 0.15);
  rig.start = {0.0, std::numbers::pi / 4, -std::numbers::pi, 0.0, -std::numbers::pi / 4, 0.0};
  std::vector<Vec3> finger;
  for (const Vec3& p : corners(finger_half, finger_middle)) finger.push_back(rig.model.X_LT * p);
  rig.parts = {{5, finger, 0.0}, {3, {hand_p_LP}, hand_radius}};
  rig.inward = -Vec3::UnitZ();
  rig.shoulder = 1;
  rig.wrist = 4;
  rig.late = 1;
  return rig;
}

}  // namespace

Rig make_rig(Arm arm, HoldKind hold) {
  Rig rig;
  if (arm == Arm::puma) {
    rig = puma();
  } else {
    rig.model = rails();
    rig.start = {0.0, 0.0, 0.0};
    rig.parts = {{2, {Vec3(0, 0, 0)}, 0.05}};
    rig.wrist = 2;
  }
  for (const ArmLink& link : rig.model.links) rig.ranges.push_back({link.lower, link.upper});
  rig.plant = rig.model;
  for (ArmLink& link : rig.plant.links) link.viscous_friction *= 0.8;
  Truth truth(rig.model, rig.parts);
  rig.X_WB.translation() = truth.tool(rig.start) + 3.0 * rig.inward;
  truth.set_wall(rig.X_WB, rig.half);
  rig.X_WB.translation() += (free_way - truth.gap(rig.start)) * rig.inward;
  if (hold == HoldKind::soft) rig.push = 120.0;
  return rig;
}

CellDescription described(const Rig& rig, const Setting& setting,
                          std::unique_ptr<ArmKinematics> kinematics) {
  CellDescription cell;
  cell.rate_hz = setting.rate;
  cell.gain_check = network::GainCheck::warning;
  ArmDescription& arm = cell.arms.emplace_back();
  arm.model = rig.model;
  arm.kinematics = std::move(kinematics);
  arm.start = rig.start;
  if (setting.arm == Arm::puma) {
    Pose X_TP = Pose::Identity();
    X_TP.translation() = finger_middle;
    arm.parts.push_back({"finger", Shape::box(finger_half), X_TP});
    X_TP.translation() = hand_p_LP;
    arm.parts.push_back({"wrist", Shape::sphere(hand_radius), X_TP, 3});
  } else {
    arm.parts.push_back({"ball", Shape::sphere(0.05)});
  }
  arm.options = rig.options;
  arm.options.has_brakes = setting.has_brakes;
  arm.options.drive_delay = static_cast<double>(rig.late);
  const double torque = rig.push > 1e3 ? rig.push : 3.0;  // [N m]
  arm.network = network::Plan()
                    .add("torque_arm", network::TorqueArm())
                    .add("multiplex", network::Multiplex())
                    .add("spaceball", network::Spaceball({.saturation = 10.0,
                                                          .angular_saturation = 10.0,
                                                          .time_constant = 0.0}))
                    .add("kbb2", network::Kbb2({.stiffness = 5000.0,
                                                .damping = 250.0,
                                                .force_limit = rig.push,
                                                .angular_stiffness = 150.0,
                                                .angular_damping = 8.0,
                                                .torque_limit = torque}))
                    .add("obstacle", network::Obstacle())
                    .add("puma_kin", network::PumaKin())
                    .add("arm_obstacle", network::ArmObstacle())
                    .add("limits", network::Limits(rig.limits, rig.ranges))
                    .add("puma_joints", network::PumaJoints(static_cast<int>(rig.start.size())));
  ForceLaw law{.range = 0.02, .surface_force = 200.0, .damping = 100.0};
  law.damping_may_rise = true;
  law.hold = setting.hold;
  if (setting.hold == HoldKind::hard) law.surface_force *= 0.01;
  cell.obstacles.push_back({"wall", Shape::box(rig.half), rig.X_WB, law});
  return cell;
}

namespace {

template <class Change>
void each_joint(Rig& rig, const Change& change) {
  for (ArmLink& link : rig.plant.links) change(link);
}

// A wrist that weighs next to nothing, next to the end of its range, which damps it much.
void lighten(Rig& rig, double inertia) {
  for (ArmModel* model : {&rig.model, &rig.plant}) {
    ArmLink& last = model->links.back();
    if (last.type == JointType::prismatic) {
      last.rotor_inertia = 5e3 * inertia;
      last.viscous_friction = 1.0;
      continue;
    }
    last.mass = 0.01;
    last.p_LC = Vec3(0, 0, 0.01);
    last.I_C_L = inertia * Mat3::Identity();
    last.rotor_inertia = 0.0;
    last.viscous_friction = 0.02;
    last.coulomb_friction = 0.05;
  }
  const double at = rig.start.back();
  rig.ranges.back() = {at - 0.05, at + 0.3};
  rig.limits.damping = 20.0;
}

void round_to(Exchange& x, double step) {
  for (double& q : x.read.q) q = step * std::round(q / step);
}

// Hardly moves, so that dry friction holds the arm against a torque that grows for seconds.
void creep(Exchange& x, double time) {
  x.command.hand.ball.linear = (time < 6.0 ? 0.5e-3 : 0.0) * x.inward;
}
void rest(Exchange& /*x*/, double /*time*/) {}

constexpr Sound sound[] = {
    {"as its model", [](Rig&) {}},
    {"held by dry friction for seconds",
     [](Rig& rig) {
       each_joint(rig, [](ArmLink& link) { link.coulomb_friction *= 2.0; });
       rig.led = creep;
     }},
    {"at rest, without noise", [](Rig& rig) { rig.led = rest; }},
    {"wrist of 1e-4 kg m^2, damped at its end", [](Rig& rig) { lighten(rig, 1e-4); }},
    {"wrist of 2e-5 kg m^2, damped at its end", [](Rig& rig) { lighten(rig, 2e-5); }},
    {"drive late by 2 ticks, as told", [](Rig& rig) { rig.late = 2; }},
    {"drive late by 4 ticks, as told", [](Rig& rig) { rig.late = 4; }},
    {"encoders of 1e-4 rad, as told",
     [](Rig& rig) {
       rig.options.joints.resolution = 1e-4;
       rig.options.joints.repeats = 4;
       rig.sensed = [](Exchange& x) { round_to(x, 1e-4); };
     }},
    {"encoders of 1e-4 rad, not told",
     [](Rig& rig) { rig.sensed = [](Exchange& x) { round_to(x, 1e-4); }; }},
    {"noise of 1e-4 rad and 0.01 rad/s",
     [](Rig& rig) {
       rig.sensed = [](Exchange& x) {
         for (double& q : x.read.q) q += x.noise(1e-4);
         for (double& v : x.read.v) v += x.noise(0.01);
       };
     }},
    {"0.6 times the inertia", [](Rig& rig) { rig.plant = with_inertia(rig.plant, 0.6); }},
    {"1.7 times the inertia", [](Rig& rig) { rig.plant = with_inertia(rig.plant, 1.7); }},
    {"half the dry friction",
     [](Rig& rig) { each_joint(rig, [](ArmLink& link) { link.coulomb_friction *= 0.5; }); }},
    {"1.5 times the dry friction",
     [](Rig& rig) { each_joint(rig, [](ArmLink& link) { link.coulomb_friction *= 1.5; }); }},
    {"half the viscous friction",
     [](Rig& rig) { each_joint(rig, [](ArmLink& link) { link.viscous_friction *= 0.5; }); }},
};

}  // namespace

std::span<const Sound> all_sound() {
  return sound;
}

}  // namespace repel::faults
