// SPDX-License-Identifier: BSD-3-Clause
#include "repel/ode/arm.hpp"

#include <ode/ode.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/simulated/arm_drive.hpp>
#include <repel/simulated/brake_torque.hpp>

#include "contacts.hpp"

namespace repel::ode {
namespace {

static_assert(sizeof(dReal) == sizeof(double), "build against an ODE in double precision");

constexpr double most_torque = 1e9;  // [N m] or [N]

// Fraction of a joint's position error that a sub-step corrects; all of it would cause oscillation.
constexpr double error_reduction = 0.8;

ArmModel validated(const ArmModel& model, const ArmOptions& options) {
  require_simulable(model);
  for (const ArmLink& link : model.links) {
    if (link.mass > 0.0 && link.I_C_L.llt().info() == Eigen::Success) continue;
    throw SetupError("link '" + link.name + "': mass is " + to_text(link.mass) +
                     " kg and its inertia " + (link.mass > 0.0 ? "not positive" : "of no use") +
                     "; allowed: both above 0, for in ODE every link moves by itself");
  }
  require_valid(options);
  return model;
}

/// Initialises ODE once; its global data stay until the program ends.
void begin_ode() {
  static const bool begun = dInitODE2(0) != 0;
  if (!begun) throw SetupError("the Open Dynamics Engine cannot be initialised");
}

}  // namespace

struct Arm::Simulation {
  Simulation(const ArmModel& given, const ArmOptions& chosen, std::span<const ContactPart> parts)
      : model(validated(given, chosen)),
        options(chosen),
        drive(chosen.watchdog),
        torque(model.links.size()),
        q(torque),
        v(torque),
        last_q(torque),
        body(model.links.size()),
        joint(body.size()),
        friction(body.size()) {
    begin_ode();
    world.reset(dWorldCreate());
    dWorldSetGravity(world.get(), model.gravity_W.x(), model.gravity_W.y(), model.gravity_W.z());
    dWorldSetERP(world.get(), error_reduction);
    dWorldSetCFM(world.get(), 0.0);
    build();
    if (!parts.empty()) contacts.emplace(world.get(), model, options, body, parts);
    std::vector<double> start;
    for (const ArmLink& link : model.links)
      start.push_back(std::clamp(0.0, link.lower, link.upper));
    reset(start, {});
  }

  [[nodiscard]] bool turns(std::size_t i) const {
    return model.links[i].type == JointType::revolute;
  }

  /// Creates bodies and joints with all joints at zero, since ODE takes that pose as joint zero.
  void build();
  /// Sets pose and velocity of every body from the joint positions and rates.
  void place() noexcept;
  void reset(std::span<const double> at, std::span<const double> moving);
  void sub_step(double h) noexcept;
  void resist(std::size_t i, double h) noexcept;
  /// Sets the dry friction of the joints; `braked` adds that of the brakes.
  void engage(bool braked) noexcept;
  void read_state() noexcept;
  [[nodiscard]] double parted() const noexcept;

  ArmModel model;
  ArmOptions options;
  ArmDrive drive;
  struct EndWorld {
    void operator()(dWorldID ended) const { dWorldDestroy(ended); }
  };
  std::unique_ptr<dxWorld, EndWorld> world;
  std::vector<double> torque, q, v, last_q;
  std::vector<dBodyID> body;  // at the centre of mass, with the axes of the link
  std::vector<dJointID> joint;
  std::vector<dJointID> friction;  // a velocity motor at zero speed with limited force
  bool engaged = false;            // the brakes are included in that limit
  std::optional<detail::Contacts> contacts;
  ArmFaults faults;
};

void Arm::Simulation::build() {
  Pose X_WL = model.X_WB;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const ArmLink& link = model.links[i];
    X_WL = X_WL * link.X_PJ;
    body[i] = dBodyCreate(world.get());
    dMass mass;
    const Mat3& I = link.I_C_L;
    dMassSetParameters(&mass, link.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
    dBodySetMass(body[i], &mass);
    dBodySetFiniteRotationMode(body[i], 1);
    place();
    dxBody* const parent = i == 0 ? nullptr : body[i - 1];
    const Vec3 axis_W = X_WL.linear() * link.axis_J;
    const Vec3 p_WJ = X_WL.translation();
    joint[i] = (turns(i) ? dJointCreateHinge : dJointCreateSlider)(world.get(), nullptr);
    friction[i] = (turns(i) ? dJointCreateAMotor : dJointCreateLMotor)(world.get(), nullptr);
    dJointAttach(joint[i], body[i], parent);
    dJointAttach(friction[i], body[i], parent);
    if (turns(i)) {
      dJointSetHingeAnchor(joint[i], p_WJ.x(), p_WJ.y(), p_WJ.z());
      dJointSetHingeAxis(joint[i], axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetAMotorNumAxes(friction[i], 1);
      dJointSetAMotorAxis(friction[i], 0, 1, axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetAMotorParam(friction[i], dParamFMax, link.coulomb_friction);
    } else {
      dJointSetSliderAxis(joint[i], axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetLMotorNumAxes(friction[i], 1);
      dJointSetLMotorAxis(friction[i], 0, 1, axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetLMotorParam(friction[i], dParamFMax, link.coulomb_friction);
    }
  }
}

void Arm::Simulation::place() noexcept {
  Pose X_WL = model.X_WB;
  Twist V_WL;  // of the origin of the link
  for (std::size_t i = 0; i < body.size() && body[i] != nullptr; ++i) {
    const ArmLink& link = model.links[i];
    const Vec3 p_before = X_WL.translation();
    X_WL = X_WL * link.X_PJ;
    const Vec3 axis_W = X_WL.linear() * link.axis_J;
    if (turns(i)) {
      X_WL.linear() = X_WL.linear() * Eigen::AngleAxisd(q[i], link.axis_J).toRotationMatrix();
    } else {
      X_WL.translation() += q[i] * axis_W;
    }
    V_WL.linear += V_WL.angular.cross(X_WL.translation() - p_before);
    (turns(i) ? V_WL.angular : V_WL.linear) += v[i] * axis_W;
    const Vec3 p_WC = X_WL * link.p_LC;
    const Vec3 v_WC = V_WL.linear + V_WL.angular.cross(p_WC - X_WL.translation());
    const Eigen::Quaterniond R(X_WL.linear());
    const dQuaternion rotation = {R.w(), R.x(), R.y(), R.z()};
    dBodySetPosition(body[i], p_WC.x(), p_WC.y(), p_WC.z());
    dBodySetQuaternion(body[i], rotation);
    dBodySetLinearVel(body[i], v_WC.x(), v_WC.y(), v_WC.z());
    dBodySetAngularVel(body[i], V_WL.angular.x(), V_WL.angular.y(), V_WL.angular.z());
  }
}

void Arm::Simulation::reset(std::span<const double> at, std::span<const double> moving) {
  require_state(model, at, moving);
  drive.reset();
  engage(false);
  std::fill(torque.begin(), torque.end(), 0.0);
  std::copy(at.begin(), at.end(), q.begin());
  std::fill(v.begin(), v.end(), 0.0);
  std::copy(moving.begin(), moving.end(), v.begin());
  place();
  if (contacts) contacts->forget();
}

// What opposes a joint is linear in its next speed v', hence one motor with a soft constraint:
//     force = (R / h) v - K e - G v',   G = R / h + B + C + h K
// with rotor inertia R, viscous friction B, and for a penetration e of a stop its spring K and
// damper C. ODE solves v' + CFM force = Vel: CFM = 1 / G, Vel = ((R / h) v - K e) / G.
void Arm::Simulation::resist(std::size_t i, double h) noexcept {
  const ArmLink& link = model.links[i];
  const double next = q[i] + h * v[i];
  const bool beyond = next < link.lower || next > link.upper;
  const double e = q[i] - std::clamp(next, link.lower, link.upper);
  const double stiffness = beyond ? options.stop_stiffness : 0.0;
  // A stop damps inward motion only; on the way out a damper would hold the joint back.
  const bool inward = beyond && (next > link.upper ? v[i] > 0.0 : v[i] < 0.0);
  const double damping = link.viscous_friction + (inward ? options.stop_damping : 0.0);
  const double G = link.rotor_inertia / h + damping + h * stiffness;
  const double velocity =
      G > 0.0 ? (link.rotor_inertia / h * v[i] - stiffness * (beyond ? e : 0.0)) / G : 0.0;
  const auto set = turns(i) ? &dJointSetHingeParam : &dJointSetSliderParam;
  set(joint[i], dParamFMax, G > 0.0 ? dInfinity : 0.0);
  set(joint[i], dParamCFM, G > 0.0 ? 1.0 / G : 0.0);
  set(joint[i], dParamVel, velocity);
}

void Arm::Simulation::engage(bool braked) noexcept {
  if (braked == engaged) return;
  engaged = braked;
  for (std::size_t i = 0; i < friction.size(); ++i) {
    const double brake = braked ? brake_torque(model, static_cast<int>(i)) : 0.0;
    const auto set = turns(i) ? &dJointSetAMotorParam : &dJointSetLMotorParam;
    set(friction[i], dParamFMax, model.links[i].coulomb_friction + brake);
  }
}

void Arm::Simulation::sub_step(double h) noexcept {
  if (drive.advance(h)) std::fill(torque.begin(), torque.end(), 0.0);
  const bool braked = drive.braked();
  engage(braked);
  for (std::size_t i = 0; i < body.size(); ++i) {
    resist(i, h);
    (turns(i) ? dJointAddHingeTorque : dJointAddSliderForce)(joint[i], braked ? 0.0 : torque[i]);
  }
  last_q = q;
  if (contacts) contacts->find(h);
  (void)dWorldStep(world.get(), h);
  if (contacts) contacts->note_forces();
  read_state();
  double sum = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) sum += std::abs(q[i]) + std::abs(v[i]);
  if (sum < 1e12) return;  // also false for NaN
  faults.state = true;
  q = last_q;
  std::fill(v.begin(), v.end(), 0.0);
  place();
}

void Arm::Simulation::read_state() noexcept {
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (turns(i)) {
      const double angle = dJointGetHingeAngle(joint[i]);
      q[i] += std::remainder(angle - q[i], 2.0 * std::numbers::pi);
      v[i] = dJointGetHingeAngleRate(joint[i]);
    } else {
      q[i] = dJointGetSliderPosition(joint[i]);
      v[i] = dJointGetSliderPositionRate(joint[i]);
    }
  }
}

double Arm::Simulation::parted() const noexcept {
  double most = 0.0;
  Pose X_WL = model.X_WB;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const ArmLink& link = model.links[i];
    X_WL = X_WL * link.X_PJ;
    if (turns(i)) {
      X_WL.linear() = X_WL.linear() * Eigen::AngleAxisd(q[i], link.axis_J).toRotationMatrix();
    } else {
      X_WL.translation() += q[i] * (X_WL.linear() * link.axis_J);
    }
    const dReal* p = dBodyGetPosition(body[i]);
    most = std::max(most, (X_WL * link.p_LC - Vec3(p[0], p[1], p[2])).norm());
    const dReal* r = dBodyGetQuaternion(body[i]);  // the next link hangs on the actual pose
    X_WL.linear() = Eigen::Quaterniond(r[0], r[1], r[2], r[3]).toRotationMatrix();
    X_WL.translation() = Vec3(p[0], p[1], p[2]) - X_WL.linear() * link.p_LC;
  }
  return most;
}

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : simulation_(std::make_unique<Simulation>(model, options, parts)) {}
Arm::~Arm() = default;
Arm::Arm(Arm&&) noexcept = default;
Arm& Arm::operator=(Arm&&) noexcept = default;

int Arm::links() const noexcept {
  return static_cast<int>(simulation_->body.size());
}

void Arm::reset(std::span<const double> q, std::span<const double> v) {
  simulation_->reset(q, v);
}

void Arm::set_torques(std::span<const double> torques) noexcept {
  simulation_->drive.heard();
  for (std::size_t i = 0; i < simulation_->body.size(); ++i) {
    const bool usable = i < torques.size() && std::abs(torques[i]) <= most_torque;
    simulation_->torque[i] = usable ? torques[i] : 0.0;
    if (!usable) simulation_->faults.torque = true;
  }
}

void Arm::step(double period) noexcept {
  if (!(period > 0.0 && std::isfinite(period))) {
    simulation_->faults.period = true;
    return;
  }
  const double h = period / simulation_->options.substeps;
  for (int part = 0; part < simulation_->options.substeps; ++part) simulation_->sub_step(h);
  if (simulation_->contacts) simulation_->contacts->end_step();
}

void Arm::enable() noexcept {
  simulation_->drive.enable();
}

void Arm::stop() noexcept {
  simulation_->drive.stop();
  std::fill(simulation_->torque.begin(), simulation_->torque.end(), 0.0);
}

void Arm::engage_brakes(bool on) noexcept {
  simulation_->drive.engage_brakes(on);
}

ArmState Arm::state() const noexcept {
  return simulation_->drive.state();
}

void Arm::read_positions(std::span<double> out) const noexcept {
  std::copy_n(simulation_->q.begin(), std::min(out.size(), simulation_->q.size()), out.begin());
}

void Arm::read_velocities(std::span<double> out) const noexcept {
  std::copy_n(simulation_->v.begin(), std::min(out.size(), simulation_->v.size()), out.begin());
}

double Arm::parted() const noexcept {
  return simulation_->parted();
}

ContactReport Arm::contact() const noexcept {
  return simulation_->contacts ? simulation_->contacts->report() : ContactReport{};
}

std::optional<Wrench> Arm::read_wrench() const noexcept {
  return simulation_->contacts ? simulation_->contacts->on_tool() : Wrench{};
}

ArmFaults Arm::faults() const noexcept {
  return simulation_->faults;
}

void Arm::clear_faults() noexcept {
  simulation_->faults = {};
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::ode
