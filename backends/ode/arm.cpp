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
#include <repel/simulated/brake_torque.hpp>

#include "contacts.hpp"

namespace repel::ode {
namespace {

static_assert(sizeof(dReal) == sizeof(double), "build against an ODE in double precision");

constexpr double strongest = 1e9;  // [N m] or [N]

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

class Engine final : public ArmEngine {
 public:
  Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts);

  void put(std::span<const double> at, std::span<const double> moving) noexcept override;
  bool sub_step(std::span<const double> torque, bool braked, double h) noexcept override;
  std::span<const double> q() const noexcept override { return q_; }
  std::span<const double> v() const noexcept override { return v_; }

  double parted() const noexcept;

 private:
  bool turns(std::size_t i) const { return model().links[i].type == JointType::revolute; }
  /// Creates bodies and joints with all joints at zero, since ODE takes that pose as joint zero.
  void build();
  /// Sets pose and velocity of every body from the joint positions and rates.
  void place() noexcept;
  void resist(std::size_t i, double h) noexcept;
  /// Sets the dry friction of the joints; `braked` adds that of the brakes.
  void engage(bool braked) noexcept;
  void read_state() noexcept;

  struct EndWorld {
    void operator()(dWorldID ended) const { dWorldDestroy(ended); }
  };
  ArmOptions options_;
  std::unique_ptr<dxWorld, EndWorld> world_;
  std::vector<double> q_, v_, last_q_;
  std::vector<dBodyID> body_;  // at the centre of mass, with the axes of the link
  std::vector<dJointID> joint_;
  std::vector<dJointID> friction_;  // a velocity motor at zero speed with limited force
  bool engaged_ = false;            // the brakes are included in that limit
  std::optional<detail::Contacts> contacts_;
};

Engine::Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts)
    : ArmEngine(validated(given, options), strongest),
      options_(options),
      q_(given.links.size()),
      v_(q_),
      last_q_(q_),
      body_(q_.size()),
      joint_(q_.size()),
      friction_(q_.size()) {
  begin_ode();
  world_.reset(dWorldCreate());
  const Vec3& g = model().gravity_W;
  dWorldSetGravity(world_.get(), g.x(), g.y(), g.z());
  dWorldSetERP(world_.get(), error_reduction);
  dWorldSetCFM(world_.get(), 0.0);
  build();
  if (!parts.empty()) {
    contacts_.emplace(world_.get(), model(), options_, body_, parts, contacts());
  }
}

void Engine::build() {
  Pose X_WL = model().X_WB;
  for (std::size_t i = 0; i < body_.size(); ++i) {
    const ArmLink& link = model().links[i];
    X_WL = X_WL * link.X_PJ;
    body_[i] = dBodyCreate(world_.get());
    dMass mass;
    const Mat3& I = link.I_C_L;
    dMassSetParameters(&mass, link.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
    dBodySetMass(body_[i], &mass);
    dBodySetFiniteRotationMode(body_[i], 1);
    place();
    dxBody* const parent = i == 0 ? nullptr : body_[i - 1];
    const Vec3 axis_W = X_WL.linear() * link.axis_J;
    const Vec3 p_WJ = X_WL.translation();
    joint_[i] = (turns(i) ? dJointCreateHinge : dJointCreateSlider)(world_.get(), nullptr);
    friction_[i] = (turns(i) ? dJointCreateAMotor : dJointCreateLMotor)(world_.get(), nullptr);
    dJointAttach(joint_[i], body_[i], parent);
    dJointAttach(friction_[i], body_[i], parent);
    if (turns(i)) {
      dJointSetHingeAnchor(joint_[i], p_WJ.x(), p_WJ.y(), p_WJ.z());
      dJointSetHingeAxis(joint_[i], axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetAMotorNumAxes(friction_[i], 1);
      dJointSetAMotorAxis(friction_[i], 0, 1, axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetAMotorParam(friction_[i], dParamFMax, link.coulomb_friction);
    } else {
      dJointSetSliderAxis(joint_[i], axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetLMotorNumAxes(friction_[i], 1);
      dJointSetLMotorAxis(friction_[i], 0, 1, axis_W.x(), axis_W.y(), axis_W.z());
      dJointSetLMotorParam(friction_[i], dParamFMax, link.coulomb_friction);
    }
  }
}

void Engine::place() noexcept {
  Pose X_WL = model().X_WB;
  Twist V_WL;  // of the origin of the link
  for (std::size_t i = 0; i < body_.size() && body_[i] != nullptr; ++i) {
    const ArmLink& link = model().links[i];
    const Vec3 p_before = X_WL.translation();
    X_WL = X_WL * link.X_PJ;
    const Vec3 axis_W = X_WL.linear() * link.axis_J;
    if (turns(i)) {
      X_WL.linear() = X_WL.linear() * Eigen::AngleAxisd(q_[i], link.axis_J).toRotationMatrix();
    } else {
      X_WL.translation() += q_[i] * axis_W;
    }
    V_WL.linear += V_WL.angular.cross(X_WL.translation() - p_before);
    (turns(i) ? V_WL.angular : V_WL.linear) += v_[i] * axis_W;
    const Vec3 p_WC = X_WL * link.p_LC;
    const Vec3 v_WC = V_WL.linear + V_WL.angular.cross(p_WC - X_WL.translation());
    const Eigen::Quaterniond R(X_WL.linear());
    const dQuaternion rotation = {R.w(), R.x(), R.y(), R.z()};
    dBodySetPosition(body_[i], p_WC.x(), p_WC.y(), p_WC.z());
    dBodySetQuaternion(body_[i], rotation);
    dBodySetLinearVel(body_[i], v_WC.x(), v_WC.y(), v_WC.z());
    dBodySetAngularVel(body_[i], V_WL.angular.x(), V_WL.angular.y(), V_WL.angular.z());
  }
}

void Engine::put(std::span<const double> at, std::span<const double> moving) noexcept {
  std::copy(at.begin(), at.end(), q_.begin());
  std::fill(v_.begin(), v_.end(), 0.0);
  std::copy(moving.begin(), moving.end(), v_.begin());
  place();
  if (contacts_) contacts_->forget();
}

// What opposes a joint is linear in its next speed v', hence one motor with a soft constraint:
//     force = (R / h) v - K e - G v',   G = R / h + B + C + h K
// with rotor inertia R, viscous friction B, and for a penetration e of a stop its spring K and
// damper C. ODE solves v' + CFM force = Vel: CFM = 1 / G, Vel = ((R / h) v - K e) / G.
void Engine::resist(std::size_t i, double h) noexcept {
  const ArmLink& link = model().links[i];
  const double next = q_[i] + h * v_[i];
  const bool beyond = next < link.lower || next > link.upper;
  const double e = q_[i] - std::clamp(next, link.lower, link.upper);
  const double stiffness = beyond ? options_.stop_stiffness : 0.0;
  // A stop damps inward motion only; on the way out a damper would hold the joint back.
  const bool inward = beyond && (next > link.upper ? v_[i] > 0.0 : v_[i] < 0.0);
  const double damping = link.viscous_friction + (inward ? options_.stop_damping : 0.0);
  const double G = link.rotor_inertia / h + damping + h * stiffness;
  const double velocity =
      G > 0.0 ? (link.rotor_inertia / h * v_[i] - stiffness * (beyond ? e : 0.0)) / G : 0.0;
  const auto set = turns(i) ? &dJointSetHingeParam : &dJointSetSliderParam;
  set(joint_[i], dParamFMax, G > 0.0 ? dInfinity : 0.0);
  set(joint_[i], dParamCFM, G > 0.0 ? 1.0 / G : 0.0);
  set(joint_[i], dParamVel, velocity);
}

void Engine::engage(bool braked) noexcept {
  if (braked == engaged_) return;
  engaged_ = braked;
  for (std::size_t i = 0; i < friction_.size(); ++i) {
    const double brake = braked ? brake_torque(model(), static_cast<int>(i)) : 0.0;
    const auto set = turns(i) ? &dJointSetAMotorParam : &dJointSetLMotorParam;
    set(friction_[i], dParamFMax, model().links[i].coulomb_friction + brake);
  }
}

bool Engine::sub_step(std::span<const double> torque, bool braked, double h) noexcept {
  engage(braked);
  for (std::size_t i = 0; i < body_.size(); ++i) {
    resist(i, h);
    (turns(i) ? dJointAddHingeTorque : dJointAddSliderForce)(joint_[i], torque[i]);
  }
  last_q_ = q_;
  if (contacts_) contacts_->find(h);
  (void)dWorldStep(world_.get(), h);
  if (contacts_) contacts_->note_forces();
  read_state();
  double sum = 0.0;
  for (std::size_t i = 0; i < q_.size(); ++i) sum += std::abs(q_[i]) + std::abs(v_[i]);
  if (sum < 1e12) return true;  // also false for NaN
  q_ = last_q_;
  std::fill(v_.begin(), v_.end(), 0.0);
  place();
  return false;
}

void Engine::read_state() noexcept {
  for (std::size_t i = 0; i < body_.size(); ++i) {
    if (turns(i)) {
      const double angle = dJointGetHingeAngle(joint_[i]);
      q_[i] += std::remainder(angle - q_[i], 2.0 * std::numbers::pi);
      v_[i] = dJointGetHingeAngleRate(joint_[i]);
    } else {
      q_[i] = dJointGetSliderPosition(joint_[i]);
      v_[i] = dJointGetSliderPositionRate(joint_[i]);
    }
  }
}

double Engine::parted() const noexcept {
  double most = 0.0;
  Pose X_WL = model().X_WB;
  for (std::size_t i = 0; i < body_.size(); ++i) {
    const ArmLink& link = model().links[i];
    X_WL = X_WL * link.X_PJ;
    if (turns(i)) {
      X_WL.linear() = X_WL.linear() * Eigen::AngleAxisd(q_[i], link.axis_J).toRotationMatrix();
    } else {
      X_WL.translation() += q_[i] * (X_WL.linear() * link.axis_J);
    }
    const dReal* p = dBodyGetPosition(body_[i]);
    most = std::max(most, (X_WL * link.p_LC - Vec3(p[0], p[1], p[2])).norm());
    const dReal* r = dBodyGetQuaternion(body_[i]);  // the next link hangs on the actual pose
    X_WL.linear() = Eigen::Quaterniond(r[0], r[1], r[2], r[3]).toRotationMatrix();
    X_WL.translation() = Vec3(p[0], p[1], p[2]) - X_WL.linear() * link.p_LC;
  }
  return most;
}

}  // namespace

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : SimulatedArm(std::make_unique<Engine>(model, options, parts), options.substeps,
                   options.watchdog) {}

double Arm::parted() const noexcept {
  return static_cast<const Engine&>(engine()).parted();
}

}  // namespace repel::ode
