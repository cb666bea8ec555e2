// SPDX-License-Identifier: BSD-3-Clause
#include "arms.hpp"

#include <cmath>
#include <limits>

#include <repel/bullet/arm.hpp>
#ifdef REPEL_ENGINES_MUJOCO
#include <repel/mujoco/arm.hpp>
#endif
#include <repel/ode/arm.hpp>
#include <repel/robots/urdf.hpp>

namespace repel::engines {

namespace {

template <class Arm, class Options>
class Adapted final : public SimulatedArm {
 public:
  Adapted(const ArmModel& model, int substeps) : arm_(model, Options{.substeps = substeps}) {}

  void reset(std::span<const double> q, std::span<const double> v) override { arm_.reset(q, v); }
  void set_torques(std::span<const double> torques) override { arm_.set_torques(torques); }
  void step(double duration) override { arm_.step(duration); }
  [[nodiscard]] std::vector<double> positions() const override {
    std::vector<double> q(static_cast<std::size_t>(arm_.links()));
    arm_.read_positions(q);
    return q;
  }
  [[nodiscard]] std::vector<double> velocities() const override {
    std::vector<double> v(static_cast<std::size_t>(arm_.links()));
    arm_.read_velocities(v);
    return v;
  }

 private:
  Arm arm_;
};

template <class Arm, class Options>
std::unique_ptr<SimulatedArm> make(const ArmModel& model, int substeps) {
  return std::make_unique<Adapted<Arm, Options>>(model, substeps);
}

ArmLink without_stops(ArmLink link) {
  link.upper = std::numeric_limits<double>::infinity();
  link.lower = -link.upper;
  return link;
}

ArmModel without_stops(ArmModel model) {
  for (ArmLink& link : model.links) link = without_stops(link);
  return model;
}

}  // namespace

const std::vector<Engine>& engines() {
  static const std::vector<Engine> all{
      {"bullet", make<bullet::Arm, bullet::ArmOptions>},
      {"ode", make<ode::Arm, ode::ArmOptions>},
#ifdef REPEL_ENGINES_MUJOCO
      {"mujoco", make<mujoco::Arm, mujoco::ArmOptions>},
#endif
      {"reference", make<ReferenceArm, ReferenceOptions>},
  };
  return all;
}

const Engine& reference() {
  return engines().back();
}

ArmModel pendulum() {
  ArmLink rod;
  rod.name = "rod";
  rod.joint_name = "pivot";
  rod.axis_J = Vec3::UnitY();
  rod.mass = 2.0;
  rod.p_LC = Vec3(0.0, 0.0, -0.5);
  rod.I_C_L = Vec3(0.03, 0.03, 0.001).asDiagonal();
  ArmModel model;
  model.name = "pendulum";
  model.links.push_back(without_stops(rod));
  return model;
}

double pendulum_frequency() {
  const ArmModel model = pendulum();
  const ArmLink& rod = model.links.front();
  const double weight = rod.mass * model.gravity_W.norm();
  const double inertia = rod.I_C_L(1, 1) + rod.mass * rod.p_LC.squaredNorm();
  return std::sqrt(weight * rod.p_LC.norm() / inertia);
}

ArmModel puma() {
  ArmModel model = without_stops(load_arm(REPEL_ROBOTS "/puma560.urdf").arm);
  for (ArmLink& link : model.links) link.coulomb_friction = 0.0;
  return model;
}

ArmModel armstrong_puma() {
  ArmModel model = without_stops(load_arm(REPEL_ROBOTS "/puma560_armstrong.urdf").arm);
  for (ArmLink& link : model.links) link.viscous_friction = link.coulomb_friction = 0.0;
  model.gravity_W = {0.0, 0.0, -9.8};
  return model;
}

ArmModel three_links() {
  ArmModel model = armstrong_puma();
  model.links.resize(3);
  model.gravity_W = {0.0, 0.0, -9.81};
  return model;
}

Energy::Energy(const ArmModel& arm)
    : model_(arm), dynamics_(arm), kinematics_(arm), M_(dynamics_.links(), dynamics_.links()) {}

double Energy::kinetic(std::span<const double> q, std::span<const double> v) {
  dynamics_.inertia(q, M_);
  const Eigen::Map<const Eigen::VectorXd> speeds(v.data(), M_.rows());
  return 0.5 * speeds.dot(M_ * speeds);
}

double Energy::potential(std::span<const double> q) {
  kinematics_.update(q);
  double energy = 0.0;
  for (int i = 0; i < kinematics_.links(); ++i) {
    const ArmLink& link = model_.links[static_cast<std::size_t>(i)];
    energy -= link.mass * model_.gravity_W.dot(kinematics_.X_WL(i) * link.p_LC);
  }
  return energy;
}

}  // namespace repel::engines
