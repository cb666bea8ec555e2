// SPDX-License-Identifier: BSD-3-Clause
#include "repel/mujoco/arm.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <repel/base/setup_error.hpp>
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

class Engine final : public ArmEngine {
 public:
  Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts);

  void put(std::span<const double> at, std::span<const double> moving) noexcept override;
  bool sub_step(std::span<const double> torque, bool braked, double h) noexcept override;
  std::span<const double> q() const noexcept override { return {data_->qpos, brake_.size()}; }
  std::span<const double> v() const noexcept override { return {data_->qvel, brake_.size()}; }

 private:
  void load(std::span<const double> torque, bool braked, double h) noexcept;
  void find_acceleration(double h);
  void require_inertia_at_every_joint();

  ArmOptions options_;
  std::vector<double> brake_;  // [N m] or [N]
  detail::Model compiled_;
  detail::Data data_;  // its state is that of the arm
  detail::Contacts law_;
};

Engine::Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts)
    : ArmEngine(validated(given, options, parts)),
      options_(options),
      compiled_(detail::compiled(model(), options, parts)),
      data_(mj_makeData(compiled_.get())),
      law_(model(), options, contacts()) {
  for (std::size_t i = 0; i < model().links.size(); ++i) {
    brake_.push_back(std::min(brake_torque(model(), static_cast<int>(i)), most_friction));
  }
  compiled_->opt.tolerance = tolerance;
  compiled_->stat.meaninertia = 1.0;
  put(start_of(model()), {});
  require_inertia_at_every_joint();
}

void Engine::put(std::span<const double> at, std::span<const double> moving) noexcept {
  mj_resetData(compiled_.get(), data_.get());
  std::copy(at.begin(), at.end(), data_->qpos);
  std::copy(moving.begin(), moving.end(), data_->qvel);
}

void Engine::require_inertia_at_every_joint() {
  const detail::ErrorsThrown scope;
  load(std::vector<double>(brake_.size()), false, 0.0);
  mj_fwdPosition(compiled_.get(), data_.get());
  for (std::size_t i = 0; i < brake_.size(); ++i) {
    if (data_->qLDiagInv[i] < 1.0 / mjMINVAL) continue;
    throw SetupError("joint '" + model().links[i].joint_name +
                     "' moves no mass; give its link a mass or an inertia about the joint axis");
  }
}

// Rotor inertia, viscous friction and stops are linear in the next speed: their implicit part is
// an inertia, as JointResistance has it, and the rest a force.
void Engine::load(std::span<const double> torque, bool braked, double h) noexcept {
  for (std::size_t i = 0; i < brake_.size(); ++i) {
    const ArmLink& link = model().links[i];
    const double v = data_->qvel[i];
    const JointResistance resistance = resistance_of(link, options_, data_->qpos[i], v, h);
    compiled_->dof_armature[i] = link.rotor_inertia + resistance.inertia(h);
    data_->qfrc_applied[i] =
        torque[i] - resistance.damping * v - resistance.stiffness * resistance.beyond;
    compiled_->dof_frictionloss[i] =
        std::min(link.coulomb_friction, most_friction) + (braked ? brake_[i] : 0.0);
  }
  compiled_->opt.timestep = h;
}

// The stages of mj_step, without its checks: they would put an arm that diverges back to zero. The
// constraints get their law between the stages. Dry friction is the force that brings a joint to
// rest within the sub-step, as far as it reaches: a + R f = -v / h with R towards 0. Each pass adds
// R f of the one before on the right, so that what R leaves becomes ever less.
void Engine::find_acceleration(double h) {
  const detail::ErrorsThrown scope;
  mj_fwdPosition(compiled_.get(), data_.get());
  mj_fwdVelocity(compiled_.get(), data_.get());
  for (int row = 0; row < data_->nf; ++row) {
    const int joint = data_->efc_id[row];
    data_->efc_R[row] = softness / data_->qM[compiled_->dof_Madr[joint]];
    data_->efc_D[row] = 1.0 / data_->efc_R[row];
    data_->efc_aref[row] = -data_->efc_vel[row] / h;
  }
  law_.set_law(*data_, h);
  mj_fwdActuation(compiled_.get(), data_.get());
  mj_fwdAcceleration(compiled_.get(), data_.get());
  mj_fwdConstraint(compiled_.get(), data_.get());
  for (int pass = 1; pass < friction_passes && data_->nf > 0; ++pass) {
    for (int row = 0; row < data_->nf; ++row) {
      data_->efc_aref[row] = data_->efc_R[row] * data_->efc_force[row] - data_->efc_vel[row] / h;
    }
    mj_fwdConstraint(compiled_.get(), data_.get());
  }
}

bool Engine::sub_step(std::span<const double> torque, bool braked, double h) noexcept {
  load(torque, braked, h);
  bool moves = false;
  try {
    find_acceleration(h);
    moves = all_finite(data_->qacc, brake_.size());
  } catch (const std::exception&) {
    moves = false;
  }
  if (moves) law_.note_forces(*compiled_, *data_);
  for (std::size_t i = 0; i < brake_.size() && moves; ++i) {
    const double v = data_->qvel[i] + h * data_->qacc[i];
    moves = std::abs(v) < mjMAXVAL && std::abs(data_->qpos[i] + h * v) < mjMAXVAL;
  }
  if (moves) {
    mj_Euler(compiled_.get(), data_.get());
    return true;
  }
  std::fill_n(data_->qvel, brake_.size(), 0.0);
  std::fill_n(data_->qacc_warmstart, brake_.size(), 0.0);
  return false;
}

}  // namespace

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : SimulatedArm(std::make_unique<Engine>(model, options, parts), options.substeps,
                   options.watchdog) {}

}  // namespace repel::mujoco
