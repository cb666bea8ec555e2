// SPDX-License-Identifier: BSD-3-Clause
#include "repel/mujoco/arm.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/simulated/arm_drive.hpp>
#include <repel/simulated/brake_torque.hpp>
#include <repel/simulated/joint_resistance.hpp>

#include "contacts.hpp"
#include "errors.hpp"
#include "model.hpp"

namespace repel::mujoco {
namespace {

// How much dry friction gives way in a solution, as a share of the mobility of the joint. MuJoCo's
// solver does not find solutions that are much harder; each pass divides the rest by it.
constexpr double softness = 1e-4;
constexpr int friction_passes = 3;

// The solver ends when a step of Newton's method improves its cost, the power over a second, by
// less than this [N m rad/s^2]. With none at all it goes on for long without moving a bit.
constexpr double tolerance = 1e-14;

constexpr double most_friction = 1e12;  // [N m] or [N], in place of infinity

ArmModel validated(const ArmModel& model, const ArmOptions& options,
                   std::span<const ContactPart> parts) {
  require_simulable(model);
  require_valid(options);
  require_touchable(parts, model);
  detail::set_handlers();
  return model;
}

bool all_finite(const mjtNum* values, std::size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

}  // namespace

struct Arm::Simulation {
  Simulation(const ArmModel& given, const ArmOptions& chosen, std::span<const ContactPart> parts);

  void reset(std::span<const double> q, std::span<const double> v);
  void sub_step(double h) noexcept;
  void load(bool braked, double h) noexcept;
  void find_acceleration(double h);
  void require_inertia_at_every_joint();

  ArmModel model;
  ArmOptions options;
  ArmDrive drive;
  std::size_t links;
  std::vector<double> brake;  // [N m] or [N]
  detail::Model compiled;
  detail::Data data;  // its state is that of the arm
  detail::Contacts contacts;
  ArmFaults faults;
  std::vector<double> torque;
};

Arm::Simulation::Simulation(const ArmModel& given, const ArmOptions& chosen,
                            std::span<const ContactPart> parts)
    : model(validated(given, chosen, parts)),
      options(chosen),
      drive(chosen.watchdog),
      links(model.links.size()),
      compiled(detail::compiled(model, options, parts)),
      data(mj_makeData(compiled.get())),
      contacts(model, options),
      torque(links) {
  for (std::size_t i = 0; i < links; ++i) {
    brake.push_back(std::min(brake_torque(model, static_cast<int>(i)), most_friction));
  }
  compiled->opt.tolerance = tolerance;
  compiled->stat.meaninertia = 1.0;
  std::vector<double> start;
  for (const ArmLink& link : model.links) start.push_back(std::clamp(0.0, link.lower, link.upper));
  reset(start, {});
  require_inertia_at_every_joint();
  reset(start, {});
}

void Arm::Simulation::reset(std::span<const double> at, std::span<const double> moving) {
  require_state(model, at, moving);
  drive.reset();
  std::fill(torque.begin(), torque.end(), 0.0);
  mj_resetData(compiled.get(), data.get());
  std::copy(at.begin(), at.end(), data->qpos);
  std::copy(moving.begin(), moving.end(), data->qvel);
  contacts.forget();
}

void Arm::Simulation::require_inertia_at_every_joint() {
  const detail::ErrorsThrown scope;
  load(false, 0.0);
  mj_fwdPosition(compiled.get(), data.get());
  for (std::size_t i = 0; i < links; ++i) {
    if (data->qLDiagInv[i] < 1.0 / mjMINVAL) continue;
    throw SetupError("joint '" + model.links[i].joint_name +
                     "' moves no mass; give its link a mass or an inertia about the joint axis");
  }
}

// Rotor inertia, viscous friction and stops are linear in the next speed: their implicit part is
// an inertia, as JointResistance has it, and the rest a force.
void Arm::Simulation::load(bool braked, double h) noexcept {
  for (std::size_t i = 0; i < links; ++i) {
    const ArmLink& link = model.links[i];
    const double v = data->qvel[i];
    const JointResistance resistance = resistance_of(link, options, data->qpos[i], v, h);
    compiled->dof_armature[i] = link.rotor_inertia + resistance.inertia(h);
    data->qfrc_applied[i] = (braked ? 0.0 : torque[i]) - resistance.damping * v -
                            resistance.stiffness * resistance.beyond;
    compiled->dof_frictionloss[i] =
        std::min(link.coulomb_friction, most_friction) + (braked ? brake[i] : 0.0);
  }
  compiled->opt.timestep = h;
}

// The stages of mj_step, without its checks: they would put an arm that diverges back to zero. The
// constraints get their law between the stages. Dry friction is the force that brings a joint to
// rest within the sub-step, as far as it reaches: a + R f = -v / h with R towards 0. Each pass adds
// R f of the one before on the right, so that what R leaves becomes ever less.
void Arm::Simulation::find_acceleration(double h) {
  const detail::ErrorsThrown scope;
  mj_fwdPosition(compiled.get(), data.get());
  mj_fwdVelocity(compiled.get(), data.get());
  for (int row = 0; row < data->nf; ++row) {
    const int joint = data->efc_id[row];
    data->efc_R[row] = softness / data->qM[compiled->dof_Madr[joint]];
    data->efc_D[row] = 1.0 / data->efc_R[row];
    data->efc_aref[row] = -data->efc_vel[row] / h;
  }
  contacts.set_law(*data, h);
  mj_fwdActuation(compiled.get(), data.get());
  mj_fwdAcceleration(compiled.get(), data.get());
  mj_fwdConstraint(compiled.get(), data.get());
  for (int pass = 1; pass < friction_passes && data->nf > 0; ++pass) {
    for (int row = 0; row < data->nf; ++row) {
      data->efc_aref[row] = data->efc_R[row] * data->efc_force[row] - data->efc_vel[row] / h;
    }
    mj_fwdConstraint(compiled.get(), data.get());
  }
}

void Arm::Simulation::sub_step(double h) noexcept {
  if (drive.advance(h)) std::fill(torque.begin(), torque.end(), 0.0);
  load(drive.braked(), h);
  bool moves = false;
  try {
    find_acceleration(h);
    moves = all_finite(data->qacc, links);
  } catch (const std::exception&) {
    moves = false;
  }
  if (moves) contacts.note_forces(*compiled, *data);
  for (std::size_t i = 0; i < links && moves; ++i) {
    const double v = data->qvel[i] + h * data->qacc[i];
    moves = std::abs(v) < mjMAXVAL && std::abs(data->qpos[i] + h * v) < mjMAXVAL;
  }
  if (moves) {
    mj_Euler(compiled.get(), data.get());
    return;
  }
  faults.state = true;
  std::fill_n(data->qvel, links, 0.0);
  std::fill_n(data->qacc_warmstart, links, 0.0);
}

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : simulation_(std::make_unique<Simulation>(model, options, parts)) {}
Arm::~Arm() = default;
Arm::Arm(Arm&&) noexcept = default;
Arm& Arm::operator=(Arm&&) noexcept = default;

int Arm::links() const noexcept {
  return static_cast<int>(simulation_->links);
}

void Arm::reset(std::span<const double> q, std::span<const double> v) {
  simulation_->reset(q, v);
}

void Arm::set_torques(std::span<const double> torques) noexcept {
  simulation_->drive.heard();
  for (std::size_t i = 0; i < simulation_->links; ++i) {
    const bool usable = i < torques.size() && std::isfinite(torques[i]);
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
  simulation_->contacts.end_step();
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
  std::copy_n(simulation_->data->qpos, std::min(out.size(), simulation_->links), out.begin());
}

void Arm::read_velocities(std::span<double> out) const noexcept {
  std::copy_n(simulation_->data->qvel, std::min(out.size(), simulation_->links), out.begin());
}

ContactReport Arm::contact() const noexcept {
  return simulation_->contacts.report();
}

std::optional<Wrench> Arm::read_wrench() const noexcept {
  return simulation_->contacts.on_tool();
}

ArmFaults Arm::faults() const noexcept {
  return simulation_->faults;
}

void Arm::clear_faults() noexcept {
  simulation_->faults = {};
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::mujoco
