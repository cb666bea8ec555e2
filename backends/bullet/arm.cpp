// SPDX-License-Identifier: BSD-3-Clause
#include "repel/bullet/arm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/simulated/arm_drive.hpp>

#include "contacts.hpp"
#include "implicit_joints.hpp"
#include "multibody.hpp"

namespace repel::bullet {
namespace {

ArmModel validated(const ArmModel& model, const ArmOptions& options) {
  detail::require_double_precision();
  require_simulable(model);
  require_valid(options);
  return model;
}

}  // namespace

struct Arm::Simulation {
  Simulation(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts);

  void reset(std::span<const double> q, std::span<const double> v);
  void sub_step(double h) noexcept;
  void read_state() noexcept;
  void load(const Eigen::VectorXd& joint_torque) noexcept;
  void find_free_acceleration() noexcept;
  void require_inertia_at_every_joint();

  ArmModel model;
  int substeps;
  ArmDrive drive;
  int links;
  detail::ImplicitJoints joints;
  std::unique_ptr<btMultiBody> body;
  std::unique_ptr<detail::Contacts> contacts;  // null without parts
  ArmFaults faults;
  Eigen::VectorXd torque, no_torque, q, v, a;  // command; zero; state; acceleration
  Eigen::MatrixXd M_inverse;
  // Bullet's scratch memory; generalized vectors have 6 entries for the base, then one per joint.
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  std::vector<btScalar> unit_force, response;
};

Arm::Simulation::Simulation(const ArmModel& given, const ArmOptions& options,
                            std::span<const ContactPart> parts)
    : model(validated(given, options)),
      substeps(options.substeps),
      drive(options.watchdog),
      links(static_cast<int>(model.links.size())),
      joints(model, options),
      body(detail::make_multibody(model)),
      contacts(parts.empty() ? nullptr : std::make_unique<detail::Contacts>(model, options, parts)),
      torque(Eigen::VectorXd::Zero(links)),
      no_torque(torque),
      q(torque),
      v(torque),
      a(torque),
      M_inverse(links, links),
      unit_force(6 + model.links.size()),
      response(6 + model.links.size()) {
  std::vector<double> start;
  for (const ArmLink& link : model.links) start.push_back(std::clamp(0.0, link.lower, link.upper));
  reset(start, {});
  require_inertia_at_every_joint();
  sub_step(1e-3);  // the first step allocates Bullet's scratch memory
  reset(start, {});
}

void Arm::Simulation::reset(std::span<const double> at, std::span<const double> moving) {
  require_state(model, at, moving);
  drive.reset();
  torque.setZero();
  body->clearForcesAndTorques();
  body->clearVelocities();
  body->setBaseWorldTransform(detail::to_bullet(model.X_WB));
  for (int i = 0; i < links; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    body->setJointPos(i, at[joint]);
    body->setJointVel(i, moving.empty() ? 0.0 : moving[joint]);
  }
  if (contacts) contacts->forget();
  read_state();
}

void Arm::Simulation::read_state() noexcept {
  for (int i = 0; i < links; ++i) {
    q[i] = body->getJointPos(i);
    v[i] = body->getJointVel(i);
  }
}

void Arm::Simulation::load(const Eigen::VectorXd& joint_torque) noexcept {
  body->clearForcesAndTorques();
  for (int i = 0; i < links; ++i) {
    body->addLinkForce(i, detail::to_bullet(Vec3(body->getLinkMass(i) * model.gravity_W)));
    body->addJointTorque(i, joint_torque[i]);
  }
}

// a = M^-1 (u - c) by the articulated-body algorithm. Then M^-1 column by column, from the factors
// that the algorithm leaves: the acceleration change due to a unit torque at one joint.
void Arm::Simulation::find_free_acceleration() noexcept {
  body->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, scalars, vectors, matrices, false,
                                                             false, false);
  for (int i = 0; i < links; ++i) a[i] = scalars[links + 6 + i];
  for (int i = 0; i < links; ++i) {
    unit_force[6 + static_cast<std::size_t>(i)] = 1.0;
    body->calcAccelerationDeltasMultiDof(unit_force.data(), response.data(), scalars, vectors);
    unit_force[6 + static_cast<std::size_t>(i)] = 0.0;
    M_inverse.col(i) = Eigen::Map<const Eigen::VectorXd>(response.data() + 6, links);
  }
}

void Arm::Simulation::require_inertia_at_every_joint() {
  load(torque);
  find_free_acceleration();
  for (int i = 0; i < links; ++i) {
    if (M_inverse(i, i) > 0.0) continue;  // Bullet returns 0 for a joint that moves no mass
    throw SetupError("joint '" + model.links[static_cast<std::size_t>(i)].joint_name +
                     "' moves no mass; give its link a mass or an inertia about the joint axis");
  }
}

// Bullet's own world is not used: it integrates only the result of its articulated-body algorithm,
// so D and f would have to be fed back as torques. That costs a second run of the algorithm and
// multiplies the rounding error of a by D / M.
void Arm::Simulation::sub_step(double h) noexcept {
  if (drive.advance(h)) torque.setZero();
  const bool braked = drive.braked();
  load(joints.linearize(q, v, braked ? no_torque : torque, h));  // gravity and joint torque
  find_free_acceleration();                                      // -> a, M^-1
  if (contacts) contacts->find(q);
  joints.solve(M_inverse, a, v, h, braked, contacts.get());  // -> a with rotors, stops and friction
  if (contacts) contacts->note_forces();
  v += h * a;
  if (!v.allFinite() || !(q + h * v).allFinite()) {
    faults.state = true;
    v.setZero();
  }
  for (int i = 0; i < links; ++i) body->setJointVel(i, v[i]);
  body->stepPositionsMultiDof(h);  // q += h v
  read_state();
}

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : simulation_(std::make_unique<Simulation>(model, options, parts)) {}
Arm::~Arm() = default;
Arm::Arm(Arm&&) noexcept = default;
Arm& Arm::operator=(Arm&&) noexcept = default;

int Arm::links() const noexcept {
  return simulation_->links;
}

void Arm::reset(std::span<const double> q, std::span<const double> v) {
  simulation_->reset(q, v);
}

void Arm::set_torques(std::span<const double> torques) noexcept {
  simulation_->drive.heard();
  for (std::size_t i = 0; i < simulation_->model.links.size(); ++i) {
    const bool usable = i < torques.size() && std::isfinite(torques[i]);
    simulation_->torque[static_cast<Eigen::Index>(i)] = usable ? torques[i] : 0.0;
    if (!usable) simulation_->faults.torque = true;
  }
}

void Arm::step(double period) noexcept {
  if (!(period > 0.0 && std::isfinite(period))) {
    simulation_->faults.period = true;
    return;
  }
  const double h = period / simulation_->substeps;
  for (int part = 0; part < simulation_->substeps; ++part) simulation_->sub_step(h);
  if (simulation_->contacts) simulation_->contacts->end_step();
}

void Arm::enable() noexcept {
  simulation_->drive.enable();
}

void Arm::stop() noexcept {
  simulation_->drive.stop();
  simulation_->torque.setZero();
}

void Arm::engage_brakes(bool on) noexcept {
  simulation_->drive.engage_brakes(on);
}

ArmState Arm::state() const noexcept {
  return simulation_->drive.state();
}

void Arm::read_positions(std::span<double> out) const noexcept {
  const auto count = std::min(out.size(), simulation_->model.links.size());
  std::copy_n(simulation_->q.begin(), count, out.begin());
}

void Arm::read_velocities(std::span<double> out) const noexcept {
  const auto count = std::min(out.size(), simulation_->model.links.size());
  std::copy_n(simulation_->v.begin(), count, out.begin());
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

}  // namespace repel::bullet
