// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/dynamics.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <limits>

#include <repel/simulated/arm_drive.hpp>
#include <repel/simulated/brake_torque.hpp>

#include "kdl_chain.hpp"

namespace repel {

namespace {

std::span<double> span_of(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

struct Dynamics::Impl {
  explicit Impl(const ArmModel& arm)
      : chain(detail::chain_of(arm)),
        solver(chain, detail::to_kdl(Vec3(arm.X_WB.linear().transpose() * arm.gravity_W))),
        links(chain.getNrOfJoints()),
        q(links),
        v(links),
        coriolis(links),
        gravity(links),
        M(links) {
    for (const ArmLink& link : arm.links) rotors.push_back(link.rotor_inertia);
  }

  KDL::Chain chain;  // the solver refers to it
  KDL::ChainDynParam solver;
  unsigned links;
  KDL::JntArray q, v, coriolis, gravity;
  KDL::JntSpaceInertiaMatrix M;
  std::vector<double> rotors;
};

Dynamics::Dynamics(const ArmModel& arm) : impl_(std::make_unique<Impl>(arm)) {}
Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;
Dynamics::~Dynamics() = default;

int Dynamics::links() const noexcept {
  return static_cast<int>(impl_->links);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
void Dynamics::inertia(std::span<const double> q, MatrixRef M) noexcept {
  std::copy(q.begin(), q.end(), impl_->q.data.begin());
  impl_->solver.JntToMass(impl_->q, impl_->M);
  M = impl_->M.data;
  for (unsigned i = 0; i < impl_->links; ++i) M(i, i) += impl_->rotors[i];
}

void Dynamics::bias(std::span<const double> q, std::span<const double> v,
                    std::span<double> out) noexcept {
  std::copy(q.begin(), q.end(), impl_->q.data.begin());
  std::copy(v.begin(), v.end(), impl_->v.data.begin());
  impl_->solver.JntToCoriolis(impl_->q, impl_->v, impl_->coriolis);
  impl_->solver.JntToGravity(impl_->q, impl_->gravity);
  for (unsigned i = 0; i < impl_->links; ++i) out[i] = impl_->coriolis(i) + impl_->gravity(i);
}

struct ReferenceArm::Impl {
  using Vector = Eigen::VectorXd;

  struct State {
    Vector q, v;
  };

  Impl(const ArmModel& model, const ReferenceOptions& given)
      : dynamics(model),
        links(model.links),
        options(given),
        drive(given.watchdog),
        M(dynamics.links(), dynamics.links()) {
    const double largest = std::numeric_limits<double>::max();
    checked("ReferenceOptions::substeps", options.substeps, 1, 100000, "");
    checked("ReferenceOptions::friction_speed", options.friction_speed,
            std::numeric_limits<double>::min(), largest, "rad/s or m/s");
    const Vector zero = Vector::Zero(dynamics.links());
    at = {zero, zero};
    torque = bias = viscous = most_held = zero;
    dynamics.inertia(span_of(at.q), M);
    for (Eigen::Index i = 0; i < zero.size(); ++i) {
      const ArmLink& link = links[static_cast<std::size_t>(i)];
      checked("joint '" + link.joint_name + "': inertia it moves", M(i, i), 1e-12, largest,
              "kg m^2 or kg");
      viscous[i] = link.viscous_friction;
      most_held[i] = link.coulomb_friction + brake_torque(model, static_cast<int>(i));
    }
  }

  /// Time derivative of the state: velocity and acceleration.
  State rate(const State& x) {
    dynamics.inertia(span_of(x.q), M);
    dynamics.bias(span_of(x.q), span_of(x.v), span_of(bias));
    Vector tau = torque - bias;
    for (Eigen::Index i = 0; i < tau.size(); ++i) {
      const ArmLink& link = links[static_cast<std::size_t>(i)];
      tau[i] -= link.viscous_friction * x.v[i] +
                link.coulomb_friction * std::tanh(x.v[i] / options.friction_speed);
    }
    return {x.v, M.llt().solve(tau)};
  }

  static State moved(const State& x, const State& rate, double h) {
    return {x.q + h * rate.q, x.v + h * rate.v};
  }

  void sub_step(double h) {
    if (drive.advance(h)) torque.setZero();
    const State next = drive.braked() ? slowed(h) : driven(h);
    if (next.q.allFinite() && next.v.allFinite()) {
      at = next;
    } else {
      at.v.setZero();
    }
  }

  State driven(double h) {
    const State k1 = rate(at);
    const State k2 = rate(moved(at, k1, 0.5 * h));
    const State k3 = rate(moved(at, k2, 0.5 * h));
    const State k4 = rate(moved(at, k3, h));
    return {at.q + h / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q),
            at.v + h / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
  }

  // Semi-implicit Euler with dry friction f, that of the brakes included, and no motor torque:
  //     (M + h B) v' = M v + h (f - c),   |f_i| <= F_i,   f_i = -F_i sign(v'_i) unless v'_i = 0.
  // The search starts from the friction that stops every joint; if that is within the bounds, the
  // arm is held without any error.
  State slowed(double h) {
    dynamics.inertia(span_of(at.q), M);
    dynamics.bias(span_of(at.q), span_of(at.v), span_of(bias));
    const Vector holding = bias - M * at.v / h;
    const Vector f = holding.cwiseMin(most_held).cwiseMax(-most_held);
    if (f == holding) return {at.q, Vector::Zero(f.size())};
    M.diagonal() += h * viscous;
    const Eigen::MatrixXd W = M.inverse();
    Vector v = h * W * (f - holding);
    oppose(W, f, h, v);
    return {at.q + h * v, v};
  }

  /// Finds the friction by projected Gauss-Seidel, starting from `f`, and updates the velocity `v`.
  void oppose(const Eigen::MatrixXd& W, Vector f, double h, Vector& v) const {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double change = 0.0;  // [rad/s] largest in this sweep
      for (Eigen::Index i = 0; i < f.size(); ++i) {
        const double stopping = f[i] - v[i] / (h * W(i, i));
        const double added = std::clamp(stopping, -most_held[i], most_held[i]) - f[i];
        f[i] += added;
        v += added * h * W.col(i);
        change = std::max(change, h * std::abs(added) * W(i, i));
      }
      if (change < settled) return;
    }
  }

  static constexpr int most_sweeps = 1000;
  static constexpr double settled = 1e-14;  // [rad/s] or [m/s]

  Dynamics dynamics;
  std::vector<ArmLink> links;
  ReferenceOptions options;
  ArmDrive drive;
  Eigen::MatrixXd M;
  State at;
  Vector torque, bias;
  Vector viscous, most_held;  // [N m s/rad]; [N m] dry friction of a joint and its brake
};

ReferenceArm::ReferenceArm(const ArmModel& model, const ReferenceOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
ReferenceArm::ReferenceArm(ReferenceArm&&) noexcept = default;
ReferenceArm& ReferenceArm::operator=(ReferenceArm&&) noexcept = default;
ReferenceArm::~ReferenceArm() = default;

int ReferenceArm::links() const noexcept {
  return impl_->dynamics.links();
}

void ReferenceArm::reset(std::span<const double> q, std::span<const double> v) {
  const auto count = impl_->links.size();
  const auto finite = [](double x) { return std::isfinite(x); };
  if (q.size() != count || (!v.empty() && v.size() != count) ||
      !std::all_of(q.begin(), q.end(), finite) || !std::all_of(v.begin(), v.end(), finite)) {
    throw SetupError("reset needs " + std::to_string(count) +
                     " finite positions, and as many velocities or none");
  }
  std::copy(q.begin(), q.end(), impl_->at.q.begin());
  impl_->at.v.setZero();
  std::copy(v.begin(), v.end(), impl_->at.v.begin());
  impl_->torque.setZero();
  impl_->drive.reset();
}

void ReferenceArm::set_torques(std::span<const double> torques) noexcept {
  impl_->drive.heard();
  for (std::size_t i = 0; i < impl_->links.size(); ++i) {
    const bool usable = i < torques.size() && std::isfinite(torques[i]);
    impl_->torque[static_cast<Eigen::Index>(i)] = usable ? torques[i] : 0.0;
  }
}

void ReferenceArm::step(double period) noexcept {
  if (!(period > 0.0 && std::isfinite(period))) return;
  const double h = period / impl_->options.substeps;
  for (int part = 0; part < impl_->options.substeps; ++part) impl_->sub_step(h);
}

void ReferenceArm::enable() noexcept {
  impl_->drive.enable();
}

void ReferenceArm::stop() noexcept {
  impl_->drive.stop();
  impl_->torque.setZero();
}

void ReferenceArm::engage_brakes(bool on) noexcept {
  impl_->drive.engage_brakes(on);
}

ArmState ReferenceArm::state() const noexcept {
  return impl_->drive.state();
}

void ReferenceArm::read_positions(std::span<double> out) const noexcept {
  std::copy_n(impl_->at.q.begin(), std::min(out.size(), impl_->links.size()), out.begin());
}

void ReferenceArm::read_velocities(std::span<double> out) const noexcept {
  std::copy_n(impl_->at.v.begin(), std::min(out.size(), impl_->links.size()), out.begin());
}

double ReferenceArm::kinetic_energy() noexcept {
  impl_->dynamics.inertia(span_of(impl_->at.q), impl_->M);
  return 0.5 * impl_->at.v.dot(impl_->M * impl_->at.v);
}

}  // namespace repel

void repel::robots::is_built_for(EigenAlignmentHere /*alignment*/,
                                 VectorRegisterHere /*size*/) noexcept {}
