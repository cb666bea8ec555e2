// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/simulated_arm.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include <repel/base/setup_error.hpp>

namespace repel {

namespace {

void require(bool fact, const ArmLink& link, const std::string& otherwise) {
  if (!fact) throw SetupError("joint '" + link.joint_name + "': " + otherwise);
}

void require_moments(const Mat3& inertia, const ArmLink& link) {
  require(inertia.allFinite() && inertia.isApprox(inertia.transpose(), 1e-9), link,
          "the inertia is not a finite symmetric matrix");
  const auto moments = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues();
  require(moments.minCoeff() >= -1e-9 * moments.maxCoeff(), link,
          "the inertia has a negative principal moment");
}

void require_simulable(const ArmLink& link) {
  const auto not_negative = [&](const char* what, double value, const char* unit) {
    checked("joint '" + link.joint_name + "': " + what, value, 0.0,
            std::numeric_limits<double>::max(), unit);
  };
  not_negative("mass", link.mass, "kg");
  not_negative("viscous friction", link.viscous_friction, "N m s/rad");
  not_negative("Coulomb friction", link.coulomb_friction, "N m");
  not_negative("rotor inertia", link.rotor_inertia, "kg m^2");
  not_negative("brake torque", link.brake_torque, "N m");
  require(is_finite(link.X_PJ) && is_rigid(link.X_PJ), link, "X_PJ is not a rigid pose");
  require(std::abs(norm(link.axis_J) - 1.0) <= 1e-9, link, "axis_J is not of unit length");
  require(is_finite(link.p_LC), link, "the centre of mass is not finite");
  require_moments(link.I_C_L, link);
  require(link.lower < link.upper, link,
          "the limits are " + to_text(link.lower) + " to " + to_text(link.upper) +
              "; the lower must be below the upper (-inf and inf: no stop)");
}

}  // namespace

void require_simulable(const ArmModel& model) {
  if (model.links.empty()) throw SetupError("arm '" + model.name + "' has no links");
  if (!is_finite(model.X_WB) || !is_rigid(model.X_WB)) {
    throw SetupError("arm '" + model.name + "': X_WB is not a rigid pose");
  }
  if (!is_finite(model.gravity_W)) {
    throw SetupError("arm '" + model.name + "': gravity is not finite");
  }
  for (const auto& link : model.links) require_simulable(link);
}

void require_valid(const SimulationOptions& options) {
  constexpr double largest = std::numeric_limits<double>::max();
  checked("SimulationOptions::substeps", options.substeps, 1, 1000, "");
  checked("SimulationOptions::stop_stiffness", options.stop_stiffness, 0.0, largest, "N m/rad");
  checked("SimulationOptions::stop_damping", options.stop_damping, 0.0, largest, "N m s/rad");
  checked("SimulationOptions::contact_stiffness", options.contact_stiffness, 0.0, 1e12, "N/m");
  checked("SimulationOptions::contact_damping", options.contact_damping, 1e-3, 1e12, "N s/m");
  checked("SimulationOptions::contact_friction", options.contact_friction, 0.0, 1e3, "");
  checked("SimulationOptions::watchdog", options.watchdog, 0.0,
          std::numeric_limits<double>::infinity(), "s");
}

void require_state(const ArmModel& model, std::span<const double> q, std::span<const double> v) {
  if (q.size() != model.links.size() || (!v.empty() && v.size() != q.size())) {
    throw SetupError("arm '" + model.name + "': reset needs " + std::to_string(model.links.size()) +
                     " positions, and as many velocities or none");
  }
  for (std::size_t i = 0; i < q.size(); ++i) {
    const ArmLink& link = model.links[i];
    checked("joint '" + link.joint_name + "': position", q[i], link.lower, link.upper, "rad or m");
    if (!std::isfinite(q[i]) || (!v.empty() && !std::isfinite(v[i]))) {
      throw SetupError("joint '" + link.joint_name + "': position or velocity is not finite");
    }
  }
}

std::vector<double> start_of(const ArmModel& model) {
  std::vector<double> start;
  for (const ArmLink& link : model.links) start.push_back(std::clamp(0.0, link.lower, link.upper));
  return start;
}

ArmEngine::ArmEngine(ArmModel model, double most_torque) noexcept
    : model_(std::move(model)), most_torque_(most_torque) {}

SimulatedArm::SimulatedArm(std::unique_ptr<ArmEngine> engine, int substeps, double watchdog)
    : engine_(std::move(engine)),
      substeps_(substeps),
      drive_(watchdog),
      torque_(engine_->model().links.size()),
      no_torque_(torque_) {
  reset(start_of(engine_->model()));
}

void SimulatedArm::reset(std::span<const double> q, std::span<const double> v) {
  require_state(engine_->model(), q, v);
  drive_.reset();
  std::fill(torque_.begin(), torque_.end(), 0.0);
  engine_->put(q, v);
  engine_->contacts().forget();
}

void SimulatedArm::set_torques(std::span<const double> torques) noexcept {
  drive_.heard();
  for (std::size_t i = 0; i < torque_.size(); ++i) {
    const bool usable = i < torques.size() && std::abs(torques[i]) <= engine_->most_torque();
    torque_[i] = usable ? torques[i] : 0.0;
    if (!usable) faults_.torque = true;
  }
}

void SimulatedArm::step(double period) noexcept {
  if (!(period > 0.0 && std::isfinite(period))) {
    faults_.period = true;
    return;
  }
  const double h = period / substeps_;
  for (int part = 0; part < substeps_; ++part) {
    if (drive_.advance(h)) std::fill(torque_.begin(), torque_.end(), 0.0);
    const bool braked = drive_.braked();
    if (!engine_->sub_step(braked ? no_torque_ : torque_, braked, h)) faults_.state = true;
  }
  engine_->contacts().end_step(substeps_);
}

void SimulatedArm::stop() noexcept {
  drive_.stop();
  std::fill(torque_.begin(), torque_.end(), 0.0);
}

void SimulatedArm::read_positions(std::span<double> out) const noexcept {
  const std::span<const double> q = engine_->q();
  std::copy_n(q.begin(), std::min(out.size(), q.size()), out.begin());
}

void SimulatedArm::read_velocities(std::span<double> out) const noexcept {
  const std::span<const double> v = engine_->v();
  std::copy_n(v.begin(), std::min(out.size(), v.size()), out.begin());
}

}  // namespace repel
